#include "krepl/surface.hpp"

#include <algorithm>
#include <cmath>

#include "terrain/curve.hpp"

namespace krepl {

Surface::Edge Surface::edge(Index e) const {
  const int style = style_[e], lower = style >> 4;
  Edge edge{EdgeKind(style & 3), Curve(style >> 2 & 3), {none, none}};
  for (int side = 0; side < 2; ++side) {
    if (side != lower) edge.feature[std::size_t(side)] = face_feature_[subdivision_.face[2 * e + Index(side)]];
  }
  return edge;
}

std::span<const Point3> Surface::guides(Index e) const {
  const auto guided = std::lower_bound(guided_edge_.begin(), guided_edge_.end(), e);
  if (guided == guided_edge_.end() || *guided != e || edge(e).curve == Curve::line) return {};
  const auto begin = guide_begin_.begin() + (guided - guided_edge_.begin());
  return {guide_.data() + begin[0], begin[1] - begin[0]};
}

std::vector<Point3> Surface::curve(Index e, int points) const {
  points = std::max(points, 3);
  const Edge edge = this->edge(e);
  std::vector<Point3> base{vertex_[subdivision_.origin[2 * e]]};
  const std::span<const Point3> between = guides(e);
  base.insert(base.end(), between.begin(), between.end());
  base.push_back(vertex_[subdivision_.origin[2 * e + 1]]);
  // A vertex on a wall is at its upper end; an edge that meets the wall further down ends there.
  const double scale = std::max(radius_, terrain_->extent());
  const bool rim = edge.kind == EdgeKind::rim;
  const Index upper = edge.feature[0] == none ? edge.feature[1] : edge.feature[0];
  const bool level = rim && terrain_->feature_kind(upper) != Terrain::FeatureKind::face;  // z does not hang on x and y
  for (Point3* end : {&base.front(), &base.back()}) {
    // On steep patches heights alone say little.
    if (!level && terrain::is_on_edge(*terrain_, radius_, edge, *end, 0x1p-34 * scale)) continue;
    const double z = rim ? terrain::project_to_curve(*terrain_, radius_, edge, *end, radius_).z
                         : terrain::height_on_edge(*terrain_, radius_, edge, *end);
    if (std::abs(z - end->z) > 0x1p-44 * scale) end->z = z;
  }
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
    Point3 on_curve =
        edge.curve == Curve::line ? near : terrain::project_to_curve(*terrain_, radius_, edge, near, whole);
    if (distance(on_curve, near) > whole) on_curve = near;
    curve.push_back(on_curve);
  }
  curve.push_back(base.back());
  return curve;
}

std::optional<std::string> Surface::validate() const {
  if (auto problem = subdivision_.validate()) return problem;
  if (face_feature_.size() != subdivision_.face_count()) return "labels and faces differ in number";
  if (face_feature_[0] != none) return "the outside has a feature";
  for (Index e = 0; e < subdivision_.edge_count(); ++e) {
    const Edge found = edge(e);
    const bool left = found.feature[0] != none, right = found.feature[1] != none;
    if (found.kind == EdgeKind::rim ? left != right : left && right) continue;
    return "the features on the two sides of edge " + std::to_string(e) + " do not belong to its kind";
  }
  return std::nullopt;
}

}  // namespace krepl
