#include "measure/edge_course.hpp"

#include <algorithm>
#include <cmath>

namespace krepl::measure {

using File = input::SubdivisionFile;

Touched touched(const File::Feature& feature, Point3 origin) {
  Touched result;
  result.count = feature.count;
  result.at = feature.at[0] - origin;
  if (feature.count == 2) {
    result.direction = unit(feature.at[1] - feature.at[0]);
    const Point3 up{0, 0, 1};
    result.over = unit(up - dot(up, result.direction) * result.direction);
  } else if (feature.count == 3) {
    result.direction = unit(cross(feature.at[1] - feature.at[0], feature.at[2] - feature.at[0]));
    if (result.direction.z < 0) result.direction = -1.0 * result.direction;
  }
  return result;
}

Point3 Touched::foot(Point3 centre) const {
  if (count == 1) return at;
  const double along = dot(centre - at, direction);
  return count == 2 ? at + along * direction : centre - along * direction;
}

Point3 Touched::normal(Point3 centre) const {
  if (count == 3) return direction;
  const Point3 away = centre - foot(centre);
  return length(away) > 0 ? unit(away) : Point3{0, 0, 1};
}

double Touched::off(Point3 centre, double radius) const {
  if (count == 3) return dot(centre - at, direction) - radius;
  return distance(centre, foot(centre)) - radius;
}

double Touched::height(Point3 p, double radius) const {
  const Point3 d = p - at;
  if (count == 3) return at.z + (radius - direction.x * d.x - direction.y * d.y) / direction.z;
  if (count == 1) return at.z + std::sqrt(std::max(0.0, radius * radius - d.x * d.x - d.y * d.y));
  const double flat = std::hypot(direction.x, direction.y);
  const double along = (direction.x * d.x + direction.y * d.y) / flat,
               aside = (direction.x * d.y - direction.y * d.x) / flat;
  return at.z + (along * direction.z + std::sqrt(std::max(0.0, radius * radius - aside * aside))) / flat;
}

double Touched::area_step(Point3 a, Point3 b, double radius) const {
  const Point3 p = a - at, q = b - at;
  if (count == 3) return dot(direction, cross(p, q)) / 2;
  if (count == 2) {  // angle times length along the axis
    const Point3 aside = cross(direction, over);
    const double angle_p = std::atan2(dot(p, aside), dot(p, over)), angle_q = std::atan2(dot(q, aside), dot(q, over));
    return radius * (angle_p + angle_q) / 2 * dot(q - p, direction);
  }
  const Point3 u = unit(p), v = unit(q);  // (1 - cos) of the polar angle times the step in longitude
  return radius * radius * cross(u, v).z / (1 + (u.z + v.z) / 2);
}

EdgeCourse::EdgeCourse(const File& file, File::Index e, Point3 origin) : edge_(file.edges[e]), radius_(file.radius) {
  for (int s = 0; s < 2; ++s) {
    has_[s] = edge_.feature[std::size_t(s)] != File::none;
    if (has_[s]) side_[s] = touched(file.features[edge_.feature[std::size_t(s)]], origin);
  }
}

Point3 EdgeCourse::nearest(Point3 near) const {
  if (edge_.curve == File::Curve::line || (!has_[0] && !has_[1])) return near;
  if (edge_.kind == File::EdgeKind::rim) {
    const Touched& upper = side_[has_[0] ? 0 : 1];
    const Point3 d{near.x - upper.at.x, near.y - upper.at.y, 0};
    return upper.count == 1 && length(d) > 0 ? upper.at + radius_ * unit(d) : near;
  }
  if (edge_.kind == File::EdgeKind::valley) return on_valley(near);
  // A seam that is a circle lies about the axis of its edge.
  const Touched& axis = side_[has_[0] && side_[0].count == 2 ? 0 : 1];
  const Point3 foot = axis.foot(near);
  return foot + radius_ * axis.normal(near);
}

/// Newton's method towards the curve where both distances are R, by the shortest way.
Point3 EdgeCourse::on_valley(Point3 near) const {
  if (!has_[0] || !has_[1]) return near;
  Point3 p = near;
  for (int i = 0; i < 20; ++i) {
    const Point3 f = side_[0].normal(p), g = side_[1].normal(p);
    const double fg = dot(f, g), det = dot(cross(f, g), cross(f, g));
    if (!(det > 1e-24)) return near;
    const double a = side_[0].off(p, radius_), b = side_[1].off(p, radius_);
    const Point3 step = (-(a - fg * b) / det) * f + (-(b - fg * a) / det) * g;
    p = p + step;
    if (length(step) <= 1e-15 * (std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z))) break;
  }
  return p;
}

}  // namespace krepl::measure
