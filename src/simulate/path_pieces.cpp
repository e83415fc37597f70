#include "simulate/path_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace krepl::simulate {
namespace {

/// The coordinates of a point in the arc's plane and along its axis, in the order that makes counter-clockwise
/// positive.
struct Planar {
  double u, v, w;
};
Planar to_plane(ArcPlane plane, Point3 p) {
  switch (plane) {
    case ArcPlane::xy:
      return {p.x, p.y, p.z};
    case ArcPlane::zx:
      return {p.z, p.x, p.y};
    case ArcPlane::yz:
      return {p.y, p.z, p.x};
  }
  return {};
}
Point3 from_plane(ArcPlane plane, Planar p) {
  switch (plane) {
    case ArcPlane::xy:
      return {p.u, p.v, p.w};
    case ArcPlane::zx:
      return {p.v, p.w, p.u};
    case ArcPlane::yz:
      return {p.w, p.u, p.v};
  }
  return {};
}

bool is_arc(const Move& move) { return move.kind == MoveKind::clockwise || move.kind == MoveKind::counter_clockwise; }

}  // namespace

Arc::Arc(Point3 from, const Move& move) : plane_(move.plane) {
  const Planar a = to_plane(plane_, from), b = to_plane(plane_, move.end), c = to_plane(plane_, move.centre);
  centre_u_ = c.u, centre_v_ = c.v, from_w_ = a.w, to_w_ = b.w;
  radius_ = std::hypot(a.u - c.u, a.v - c.v), end_radius_ = std::hypot(b.u - c.u, b.v - c.v);
  start_angle_ = std::atan2(a.v - c.v, a.u - c.u);
  sense_ = move.kind == MoveKind::counter_clockwise ? 1 : -1;
  angle_ = sense_ * (std::atan2(b.v - c.v, b.u - c.u) - start_angle_);
  if (a.u == b.u && a.v == b.v)
    angle_ = 2 * std::numbers::pi;
  else if (angle_ <= 0)
    angle_ += 2 * std::numbers::pi;
}

double Arc::length() const {
  return std::hypot((radius_ + end_radius_) / 2 * angle_, to_w_ - from_w_, end_radius_ - radius_);
}

Point3 Arc::at(double fraction) const {
  const double angle = start_angle_ + sense_ * angle_ * fraction;
  const double r = radius_ + fraction * (end_radius_ - radius_);
  return from_plane(plane_, {centre_u_ + r * std::cos(angle), centre_v_ + r * std::sin(angle),
                             from_w_ + fraction * (to_w_ - from_w_)});
}

std::size_t Arc::chords(double error) const {
  // A change of the radius by d over the arc adds 2 d angle to the second derivative by the fraction.
  const double bend = radius() * angle_ * angle_ + 2 * std::abs(end_radius_ - radius_) * angle_;
  return std::size_t(std::clamp(std::ceil(std::sqrt(bend / (8 * error))), 1.0, 1e7));
}

std::vector<Piece> pieces_of(const ToolPath& path, Point3 origin, double lift, double arc_error) {
  std::vector<Piece> pieces;
  const auto tip = [&](Point3 p) { return Point3{p.x - origin.x, p.y - origin.y, p.z - lift - origin.z}; };
  Point3 from = path.start;
  for (std::size_t i = 0; i < path.moves.size(); ++i) {
    const Move& move = path.moves[i];
    Piece piece{tip(from), tip(from), std::uint32_t(i), move.kind == MoveKind::rapid};
    if (is_arc(move)) {
      const Arc arc(from, move);
      const std::size_t chords = arc.chords(arc_error);
      for (std::size_t k = 1; k < chords; ++k, piece.from = piece.to) {
        piece.to = tip(arc.at(double(k) / double(chords)));
        pieces.push_back(piece);
      }
    }
    piece.to = tip(move.end);
    pieces.push_back(piece);
    from = move.end;
  }
  return pieces;
}

double length_of(Point3 from, const Move& move) {
  if (is_arc(move)) return Arc(from, move).length();
  return std::hypot(move.end.x - from.x, move.end.y - from.y, move.end.z - from.z);
}

}  // namespace krepl::simulate
