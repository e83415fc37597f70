#include "section/patch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kernel/vectors.hpp"

namespace krepl::section {

using namespace vectors;
using Kind = Terrain::FeatureKind;

Patch::Patch(const Terrain& terrain, Index feature, double radius, double scale)
    : kind_(terrain.feature_kind(feature)), radius_(radius), scale_(scale) {
  const Terrain::Corners corners = terrain.corners(feature);
  at_ = corners.point[0];
  if (kind_ == Kind::face) {
    normal_ = unit(cross(corners.point[1] - at_, corners.point[2] - at_));
    if (normal_.z < 0) normal_ = -1.0 * normal_;
  }
  if (kind_ == Kind::edge) {
    const Point3 d = corners.point[1] - at_;
    const double flat = std::hypot(d.x, d.y);
    g_ = {d.x / flat, d.y / flat};
    m_ = d.z / flat;
    horizontal_ = std::abs(d.z) <= 0x1p-46 * scale;
    if (horizontal_) m_ = 0;
    q_ = std::sqrt(1 + m_ * m_);
  }
}

double Patch::height(Point p) const {
  const double dx = p.x - at_.x, dy = p.y - at_.y, square = radius_ * radius_;
  if (kind_ == Kind::face) return at_.z + (radius_ - normal_.x * dx - normal_.y * dy) / normal_.z;
  if (kind_ == Kind::vertex) return at_.z + std::sqrt(std::max(0.0, square - dx * dx - dy * dy));
  const double b = aside(p);
  return at_.z + m_ * along(p) + q_ * std::sqrt(std::max(0.0, (radius_ - b) * (radius_ + b)));
}

double Patch::top() const {
  const bool has_top = kind_ == Kind::vertex || (kind_ == Kind::edge && horizontal_);
  return has_top ? at_.z + radius_ : -std::numeric_limits<double>::infinity();
}

/// Of a point of the cylinder around its axis: 0 where it ends on the left, pi on the right.
double Patch::angle(Point3 p) const {
  const double up = (p.z - at_.z - m_ * along({p.x, p.y})) / q_;
  return std::atan2(std::max(0.0, up), aside({p.x, p.y}));
}

/// True if a stretch of a cylinder does not differ from a straight line.
bool Patch::is_flat(double from, double to) const {
  const double angle = to - from;
  return q_ * radius_ * angle * angle <= 0x1p-46 * scale_;
}

Patch::Place Patch::place_at_level(Point p, double level) const {
  if (kind_ == Kind::vertex) return {0, std::atan2(p.y - at_.y, p.x - at_.x)};
  if (kind_ == Kind::face) return {0, normal_.x * (p.y - at_.y) - normal_.y * (p.x - at_.x)};
  if (horizontal_) {
    const double t = along(p);
    return aside(p) < 0 ? Place{0, t} : Place{1, -t};
  }
  const double around = angle({p.x, p.y, level});
  return {0, m_ > 0 ? around : -around};
}

CutPiece Patch::level_piece(Point3 start, Point3 end) const {
  CutPiece piece;
  piece.start = start;
  piece.end = end;
  if (kind_ == Kind::face || horizontal_) return piece;
  const double level = start.z;
  if (kind_ == Kind::vertex) {
    piece = level_circle(level);
    piece.start = start, piece.end = end;
    piece.from = std::atan2(start.y - at_.y, start.x - at_.x);
    piece.to = std::atan2(end.y - at_.y, end.x - at_.x);
    return piece;
  }
  piece.from = angle(start);
  piece.to = angle(end);
  if (std::abs(m_) < 1e-6 && is_flat(piece.from, piece.to)) return piece;
  piece.kind = CutPiece::Kind::ellipse;
  const double middle = (level - at_.z) / m_, length = -q_ * radius_ / m_;
  piece.centre = {at_.x + middle * g_.x, at_.y + middle * g_.y, level};
  piece.axis = {Point3{-radius_ * g_.y, radius_ * g_.x, 0}, Point3{length * g_.x, length * g_.y, 0}};
  return piece;
}

Point Patch::on_level_circle(double level, double angle) const {
  const double size = (1 - 0x1p-20) * level_circle(level).axis[0].x;
  return {at_.x + size * std::cos(angle), at_.y + size * std::sin(angle)};
}

CutPiece Patch::level_circle(double level) const {
  CutPiece piece;
  piece.kind = CutPiece::Kind::circle;
  const double up = level - at_.z, size = std::sqrt(std::max(0.0, (radius_ - up) * (radius_ + up)));
  piece.centre = {at_.x, at_.y, level};
  piece.axis = {Point3{size, 0, 0}, Point3{0, size, 0}};
  piece.start = piece.end = {at_.x + size, at_.y, level};
  piece.to = 2 * std::numbers::pi;
  return piece;
}

CutPiece Patch::line_piece(Point3 start, Point3 end, const Line& line) const {
  CutPiece piece;
  piece.start = start;
  piece.end = end;
  if (kind_ == Kind::face) return piece;
  const Point d = line.direction;
  const auto point_of = [&](double t, double z) { return Point3{line.base.x + t * d.x, line.base.y + t * d.y, z}; };
  if (kind_ == Kind::vertex) {
    const double middle = line.along(at()), off = line.aside(at());
    const double size = std::sqrt(std::max(0.0, (radius_ - off) * (radius_ + off)));
    piece.kind = CutPiece::Kind::circle;
    piece.centre = point_of(middle, at_.z);
    piece.axis = {Point3{size * d.x, size * d.y, 0}, Point3{0, 0, size}};
    const auto around = [&](Point3 p) {
      return std::atan2(std::max(0.0, p.z - at_.z), line.along({p.x, p.y}) - middle);
    };
    piece.from = around(start);
    piece.to = around(end);
    return piece;
  }
  const double across = d.y * g_.x - d.x * g_.y, forward = d.x * g_.x + d.y * g_.y;
  if (across == 0) return piece;
  piece.from = angle(start);
  piece.to = angle(end);
  if (std::abs(across) < 1e-6 && is_flat(piece.from, piece.to)) return piece;
  const double middle = -aside(line.base) / across, reach = radius_ / across;
  piece.kind = CutPiece::Kind::ellipse;
  piece.centre = point_of(middle, at_.z + m_ * (along(line.base) + forward * middle));
  piece.axis = {Point3{reach * d.x, reach * d.y, reach * m_ * forward}, Point3{0, 0, q_ * radius_}};
  constexpr double same = 1e-15;
  if (std::abs(m_ * forward) <= same && std::abs(q_ * std::abs(across) - 1) <= same)
    piece.kind = CutPiece::Kind::circle;
  return piece;
}

}  // namespace krepl::section
