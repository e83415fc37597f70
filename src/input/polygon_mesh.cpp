#include "input/polygon_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/orientation.hpp"

namespace krepl::input {

namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// The polygon in the coordinate plane that it faces most, counter-clockwise. Empty if it has no area there.
std::vector<Point> projected(std::span<const Point3> vertices, std::span<const std::uint32_t> polygon) {
  Point3 normal;  // Newell's
  const Point3 o = vertices[polygon[0]];
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point3 a = vertices[polygon[i]], b = vertices[polygon[(i + 1) % polygon.size()]];
    const Point3 p{a.x - o.x, a.y - o.y, a.z - o.z}, q{b.x - o.x, b.y - o.y, b.z - o.z};
    normal = {normal.x + (p.y - q.y) * (p.z + q.z), normal.y + (p.z - q.z) * (p.x + q.x),
              normal.z + (p.x - q.x) * (p.y + q.y)};
  }
  const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z), most = std::max({x, y, z});
  if (!(most > 0)) return {};
  const double side = most == z ? normal.z : most == x ? normal.x : normal.y;
  std::vector<Point> plane;
  plane.reserve(polygon.size());
  for (const std::uint32_t v : polygon) {
    const Point3 p = vertices[v];
    const Point q = most == z ? Point{p.x, p.y} : most == x ? Point{p.y, p.z} : Point{p.z, p.x};
    plane.push_back(side > 0 ? q : Point{q.y, q.x});
  }
  return plane;
}

void fan(std::span<const std::uint32_t> polygon, std::vector<Triangle>& triangles) {
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) triangles.push_back({polygon[0], polygon[i], polygon[i + 1]});
}

/// True if the diagonals from corner 0 cut the polygon into triangles of positive area.
bool fan_is_proper(const std::vector<Point>& p) {
  const std::size_t n = p.size();
  for (std::size_t i = 0; i < n; ++i)
    if (kernel::orientation(p[i], p[(i + 1) % n], p[(i + 2) % n]) <= 0) return false;
  for (std::size_t i = 1; i + 1 < n; ++i)
    if (kernel::orientation(p[0], p[i], p[i + 1]) <= 0) return false;
  return true;
}

class EarClipper {
 public:
  EarClipper(const std::vector<Point>& plane, std::span<const std::uint32_t> polygon, std::vector<Triangle>& triangles)
      : p_(plane),
        polygon_(polygon),
        triangles_(triangles),
        before_(plane.size()),
        after_(plane.size()),
        left_(plane.size()) {
    for (std::size_t i = 0; i < left_; ++i) before_[i] = (i + left_ - 1) % left_, after_[i] = (i + 1) % left_;
  }

  bool run() {
    bool proper = true;
    std::size_t i = 0, tried = 0;
    while (left_ > 3) {
      if (is_ear(i)) {
        i = clip(i), tried = 0;
      } else if (++tried > left_) {
        // Only a polygon that crosses or touches itself, or has no area any more, is without an ear.
        proper = proper && turn(i) == 0;
        i = clip(i), tried = 0;
      } else {
        i = after_[i];
      }
    }
    proper = proper && turn(i) >= 0;
    clip(i);
    return proper;
  }

 private:
  int turn(std::size_t i) const { return kernel::orientation(p_[before_[i]], p_[i], p_[after_[i]]); }

  bool is_ear(std::size_t i) const {
    if (turn(i) <= 0) return false;
    const Point a = p_[before_[i]], b = p_[i], c = p_[after_[i]];
    for (std::size_t j = after_[after_[i]]; j != before_[i]; j = after_[j]) {
      const Point q = p_[j];
      if (q == a || q == b || q == c) continue;
      if (kernel::orientation(a, b, q) >= 0 && kernel::orientation(b, c, q) >= 0 && kernel::orientation(c, a, q) >= 0)
        return false;
    }
    return true;
  }

  std::size_t clip(std::size_t i) {
    triangles_.push_back({polygon_[before_[i]], polygon_[i], polygon_[after_[i]]});
    after_[before_[i]] = after_[i], before_[after_[i]] = before_[i];
    --left_;
    return after_[i];
  }

  const std::vector<Point>& p_;
  std::span<const std::uint32_t> polygon_;
  std::vector<Triangle>& triangles_;
  std::vector<std::size_t> before_, after_;
  std::size_t left_;
};

/// Of corners that follow each other. Triangles keep theirs: the model counts triangles without area.
void drop_repetitions(std::vector<std::uint32_t>& polygon) {
  if (polygon.size() <= 3) return;
  polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
  while (polygon.size() > 1 && polygon.front() == polygon.back()) polygon.pop_back();
}

std::string counted(std::size_t n, const char* one, const char* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

}  // namespace

bool triangulate(std::span<const Point3> vertices, std::span<const std::uint32_t> polygon,
                 std::vector<Triangle>& triangles) {
  if (polygon.size() == 3) {
    triangles.push_back({polygon[0], polygon[1], polygon[2]});
    return true;
  }
  const std::vector<Point> plane = projected(vertices, polygon);
  if (plane.empty() || fan_is_proper(plane)) {
    fan(polygon, triangles);
    return true;
  }
  return EarClipper(plane, polygon, triangles).run();
}

Result<TriangleMesh> cut_into_triangles(PolygonMesh mesh, const Context& context) {
  const auto place = [&](std::size_t i) { return std::string(mesh.place_name) + " " + std::to_string(mesh.place[i]); };
  if (mesh.vertices.size() >= std::numeric_limits<std::uint32_t>::max()) {
    return Error{ErrorCode::input, "there are more than 2^32 vertices", "", "split the input"};
  }
  TriangleMesh result;
  result.triangles.reserve(mesh.polygon_count());
  std::vector<std::uint32_t> polygon;
  std::size_t too_small = 0, crossing = 0;
  for (std::size_t i = 0; i < mesh.polygon_count(); ++i) {
    if (i % 65536 == 0 && context.cancelled()) return Error{ErrorCode::cancelled, "interrupted while reading", "", ""};
    polygon.clear();
    for (std::uint64_t k = mesh.begin[i]; k < mesh.begin[i + 1]; ++k) {
      const std::int64_t v = mesh.corners[k];
      if (v < 0 || std::uint64_t(v) >= mesh.vertices.size()) {
        return Error{ErrorCode::input, "a face has a vertex that does not exist", place(i),
                     "there are " + std::to_string(mesh.vertices.size()) + " vertices; correct the file"};
      }
      polygon.push_back(std::uint32_t(v));
    }
    drop_repetitions(polygon);
    if (polygon.size() < 3)
      ++too_small;
    else if (!triangulate(mesh.vertices, polygon, result.triangles))
      ++crossing;
  }
  if (result.triangles.empty()) {
    return Error{ErrorCode::input, mesh.vertices.empty() ? "has no triangles" : "has points but no triangles", "",
                 "give a mesh of triangles or polygons"};
  }
  result.notes = std::move(mesh.notes);
  if (too_small > 0)
    result.notes.push_back("note: " + counted(too_small, "face", "faces") + " with fewer than three corners left out");
  if (crossing > 0)
    result.notes.push_back("note: " + counted(crossing, "polygon crosses itself", "polygons cross themselves"));
  result.vertices = std::move(mesh.vertices);
  return result;
}

}  // namespace krepl::input
