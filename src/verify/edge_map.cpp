#include "verify/edge_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace krepl::verify {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A chord above the place; its curve meets the ray between low and high.
struct Hit {
  double low, high;
  SurfaceCase::Index below;
};

}  // namespace

double plane_distance(double x, double y, Space<double> a, Space<double> b) {
  const Space<double> p(x, y, 0);
  return length(p - nearest_on_segment(p, Space<double>(a.x, a.y, 0), Space<double>(b.x, b.y, 0)));
}

EdgeMap::EdgeMap(const SurfaceCase& surface) : surface_(surface) {
  std::vector<Box3> boxes(surface.file.edges.size());
  for (std::size_t e = 0; e < boxes.size(); ++e) boxes[e] = box_of(Index(e));
  tree_ = BoxHierarchy(boxes);
}

Box3 EdgeMap::box_of(Index edge) const {
  Box3 box;
  for (std::uint64_t i = surface_.file.edges[edge].first; i < surface_.file.points_end(edge); ++i) {
    const Point3& p = surface_.file.points[i];
    box.add(p.x, p.y, 0);
  }
  box.grow(surface_.sag[edge]);
  return box;
}

void EdgeMap::locate(double x, double y, std::vector<Index>& faces, Index without) const {
  faces.clear();
  thread_local std::vector<Hit> hits;
  hits.clear();
  double top = infinity;
  const auto key = [&](const Box3& b) { return x < b.low[0] || x > b.high[0] || y > b.high[1] ? infinity : b.low[1]; };
  const auto visit = [&](Index e) {
    if (without != SurfaceCase::none &&
        surface_.component[surface_.file.half_edges[surface_.forward[e]].origin] == without)
      return;
    const double sag = surface_.sag[e];
    Space<double> a = surface_.point(surface_.file.edges[e].first);
    bool near = false;
    for (std::uint64_t i = surface_.file.edges[e].first + 1; i < surface_.file.points_end(e); ++i) {
      const Space<double> b = surface_.point(i), from = a;
      a = b;
      if (std::max(from.y, b.y) + sag < y) continue;
      near = near || plane_distance(x, y, from, b) <= sag;
      if ((from.x <= x) == (b.x <= x)) continue;
      const double dx = b.x - from.x, dy = b.y - from.y;
      const double at = from.y + (x - from.x) / dx * dy, off = sag * std::hypot(dx, dy) / std::abs(dx);
      if (at < y) continue;  // a curve that passes on the other side of the place is near it
      hits.push_back({at - off, at + off, dx < 0 ? surface_.left_face(e) : surface_.right_face(e)});
      if (at - off > y) top = std::min(top, at + off);  // a curve that may pass below leaves the next ones above open
    }
    if (near) faces.push_back(surface_.left_face(e)), faces.push_back(surface_.right_face(e));
  };
  tree_.search(
      key, [&] { return top; }, visit);
  for (const Hit& hit : hits)
    if (hit.low <= top) faces.push_back(hit.below);
  if (hits.empty()) faces.push_back(0);
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
}

}  // namespace krepl::verify
