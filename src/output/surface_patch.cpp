#include "output/surface_patch.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/orientation.hpp"
#include "kernel/vectors.hpp"

namespace krepl::output {

namespace {

using Kind = Terrain::FeatureKind;

using namespace vectors;

}  // namespace

SurfacePatch::SurfacePatch(const Terrain& terrain, Terrain::Index feature, double radius)
    : SurfacePatch(terrain.feature_kind(feature), terrain.corners(feature), radius) {}

SurfacePatch::SurfacePatch(Kind kind, const Terrain::Corners& corners, double radius)
    : kind_(kind), radius_(radius), corners_(corners), at_(corners_.point[0]) {
  if (kind_ == Kind::edge) direction_ = unit(corners_.point[1] - at_);
  if (kind_ == Kind::face) {
    direction_ = unit(cross(corners_.point[1] - at_, corners_.point[2] - at_));
    if (direction_.z < 0) direction_ = {-direction_.x, -direction_.y, -direction_.z};
  }
}

double SurfacePatch::height(double x, double y) const {
  const double dx = x - at_.x, dy = y - at_.y;
  if (kind_ == Kind::face) return at_.z + (radius_ - direction_.x * dx - direction_.y * dy) / direction_.z;
  if (kind_ == Kind::vertex) return at_.z + std::sqrt(std::max(0.0, radius_ * radius_ - dx * dx - dy * dy));
  const double flat = std::hypot(direction_.x, direction_.y);
  const double along = (direction_.x * dx + direction_.y * dy) / flat, aside = (direction_.x * dy - direction_.y * dx) / flat;
  return at_.z + (along * direction_.z + std::sqrt(std::max(0.0, radius_ * radius_ - aside * aside))) / flat;
}

bool SurfacePatch::is_over_feature(Point3 p) const {
  if (kind_ == Kind::vertex) return true;
  const auto& corner = corners_.point;
  if (kind_ == Kind::edge) return dot(p - at_, direction_) >= 0 && dot(p - corner[1], direction_) <= 0;
  const Point touched{p.x - radius_ * direction_.x, p.y - radius_ * direction_.y};
  int left = 0, right = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point3 a = corner[i], b = corner[(i + 1) % 3];
    const int side = kernel::orientation({a.x, a.y}, {b.x, b.y}, touched);
    left += side > 0, right += side < 0;
  }
  return left == 0 || right == 0;
}

Point3 SurfacePatch::normal(Point3 p) const {
  if (kind_ == Kind::face) return direction_;
  Point3 away = p - at_;
  if (kind_ == Kind::edge) {
    const double along = dot(away, direction_);
    away = {away.x - along * direction_.x, away.y - along * direction_.y, away.z - along * direction_.z};
  }
  return dot(away, away) > 0 ? unit(away) : Point3{0, 0, 1};
}

double SurfacePatch::curved_square(Point3 a, Point3 b) const {
  if (kind_ == Kind::face) return 0;
  const Point3 d = b - a;
  const Point3 curved = kind_ == Kind::vertex ? d : cross(d, direction_);
  return dot(curved, curved);
}

double SurfacePatch::sagitta(double curved_square) const {
  const double quarter = std::min(curved_square / 4, radius_ * radius_);
  return quarter / (radius_ + std::sqrt(radius_ * radius_ - quarter));
}

double SurfacePatch::deviation(Point3 a, Point3 b, Point3 c) const {
  double square[] = {curved_square(a, b), curved_square(b, c), curved_square(c, a)};
  std::sort(square, square + 3);
  // Of a cylinder, and of a sphere under an obtuse triangle, the farthest place is the middle of the longest side; else the
  // centre of the circumscribed circle.
  if (kind_ != Kind::vertex || square[0] + square[1] <= square[2]) return sagitta(square[2]);
  const Point3 normal = cross(b - a, c - a);
  const double circumradius_square = square[0] * square[1] / (4 * dot(normal, normal)) * square[2];
  return sagitta(4 * circumradius_square);
}

}  // namespace krepl::output
