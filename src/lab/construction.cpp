#include "lab/construction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace krepl::lab {

namespace {

using Corners = std::array<Point3, 3>;

Corners corners_of(const Construction& c, const Construction::Triangle& t) {
  return {c.vertices[t[0]], c.vertices[t[1]], c.vertices[t[2]]};
}

/// The least and the greatest of the corners along a direction of the plane.
std::array<double, 2> reach(const Corners& t, double x, double y) {
  const double a = t[0].x * x + t[0].y * y, b = t[1].x * x + t[1].y * y, c = t[2].x * x + t[2].y * y;
  return {std::min({a, b, c}), std::max({a, b, c})};
}

/// Convex sets are apart if and only if a line along one of their sides parts them.
bool apart(const Corners& a, const Corners& b, double thin) {
  for (const Corners* t : {&a, &b}) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Point3 p = (*t)[k], q = (*t)[(k + 1) % 3];
      const double length = std::hypot(q.x - p.x, q.y - p.y);
      if (!(length > 0)) continue;
      const double x = (p.y - q.y) / length, y = (q.x - p.x) / length;
      const auto first = reach(a, x, y), second = reach(b, x, y);
      if (std::min(first[1], second[1]) - std::max(first[0], second[0]) <= thin) return true;
    }
  }
  return false;
}

double thinness(const Construction& c) {
  double largest = 0;
  for (const Point3& p : c.vertices) largest = std::max({largest, std::fabs(p.x), std::fabs(p.y)});
  return 1e-9 * largest;
}

}  // namespace

Result<std::shared_ptr<const Terrain>> terrain_of(const Construction& construction) {
  Context context;
  context.threads = 1;
  Result<Terrain> terrain = Terrain::from_triangles(construction.vertices, construction.triangles, context);
  if (!terrain) return terrain.error();
  return std::make_shared<const Terrain>(std::move(*terrain));
}

std::string obj_text(const Construction& construction, const std::string& title) {
  std::string text = fmt::format("# {}\n# {} triangles, for a ball of radius {}\n", title,
                                 construction.triangles.size(), construction.radius);
  const auto out = std::back_inserter(text);
  for (const Point3& p : construction.vertices) fmt::format_to(out, "v {} {} {}\n", p.x, p.y, p.z);
  for (const auto& t : construction.triangles) fmt::format_to(out, "f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

bool projections_overlap(const Construction& construction) {
  const double thin = thinness(construction);
  const auto& t = construction.triangles;
  for (std::size_t i = 0; i < t.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!apart(corners_of(construction, t[i]), corners_of(construction, t[j]), thin)) return true;
    }
  }
  return false;
}

bool projections_overlap_at(const Construction& construction, Terrain::Index v) {
  const double thin = thinness(construction);
  for (const auto& t : construction.triangles) {
    if (std::find(t.begin(), t.end(), v) == t.end()) continue;
    for (const auto& other : construction.triangles) {
      if (&other != &t && !apart(corners_of(construction, t), corners_of(construction, other), thin)) return true;
    }
  }
  return false;
}

}  // namespace krepl::lab
