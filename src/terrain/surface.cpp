#include "krepl/surface.hpp"

#include <algorithm>
#include <cmath>

#include "terrain/curve.hpp"

namespace krepl {

std::vector<Point3> Surface::curve(Index e, int points) const {
  points = std::max(points, 3);
  std::vector<Point3> base{vertex_[subdivision_.origin[2 * e]]};
  base.insert(base.end(), guide_.begin() + guide_begin_[e], guide_.begin() + guide_begin_[e + 1]);
  base.push_back(vertex_[subdivision_.origin[2 * e + 1]]);
  // A vertex on a wall is at its upper end; an edge that meets the wall further down ends there.
  const double scale = std::max(radius_, terrain_->extent());
  for (Point3* end : {&base.front(), &base.back()}) {
    const double z = edge_[e].kind == EdgeKind::rim ? terrain::project_to_curve(*terrain_, radius_, edge_[e], *end).z
                                                    : terrain::height_on_edge(*terrain_, radius_, edge_[e], *end);
    if (std::fabs(z - end->z) > 1e-7 * scale) end->z = z;
  }
  if (edge_[e].curve == Curve::line) base.erase(base.begin() + 1, base.end() - 1);
  const auto distance = [](Point3 p, Point3 q) { return std::hypot(p.x - q.x, p.y - q.y, p.z - q.z); };
  double whole = 0;
  for (std::size_t i = 1; i < base.size(); ++i) whole += distance(base[i - 1], base[i]);

  std::vector<Point3> curve{base.front()};
  std::size_t piece = 1;
  double passed = 0;
  for (int k = 1; k + 1 < points; ++k) {
    const double wanted = whole * k / (points - 1);
    double length = distance(base[piece - 1], base[piece]);
    while (piece + 1 < base.size() && passed + length < wanted) {
      passed += length;
      ++piece;
      length = distance(base[piece - 1], base[piece]);
    }
    const double t = length > 0 ? std::clamp((wanted - passed) / length, 0.0, 1.0) : 0.0;
    const Point3 p = base[piece - 1], q = base[piece];
    const Point3 near{p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), p.z + t * (q.z - p.z)};
    curve.push_back(edge_[e].curve == Curve::line ? near : terrain::project_to_curve(*terrain_, radius_, edge_[e], near));
  }
  curve.push_back(base.back());
  return curve;
}

std::optional<std::string> Surface::validate() const {
  if (auto problem = subdivision_.validate()) return problem;
  if (face_feature_.size() != subdivision_.face_count()) return "labels and faces differ in number";
  if (face_feature_[0] != none) return "the outside has a feature";
  for (Index h = 0; h < subdivision_.half_edge_count(); ++h) {
    const Edge& e = edge_[h / 2];
    const Index expected = e.feature[h & 1u], found = face_feature_[subdivision_.face[h]];
    if (expected == found || (e.kind == EdgeKind::rim && expected == none)) continue;
    return "half-edge " + std::to_string(h) + " names another feature than its face " + std::to_string(subdivision_.face[h]);
  }
  return std::nullopt;
}

}  // namespace krepl
