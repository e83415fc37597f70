#include "output/linear.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "output/zone_curves.hpp"

namespace krepl::output {

namespace {

// A chord over the angle s deviates by r (1 - cos(s/2)) = 2 r sin^2(s/4): this form does not cancel for small s.
double sagitta(double radius, double step) {
  double s = std::sin(step / 4);
  return 2 * radius * s * s;
}

double step_of(double radius, double max_error) {
  double ratio = std::min(1.0, max_error / (2 * radius));
  // A quarter turn at most, so that even a circle asked for coarsely stays a polygon; and a little less than asked for, so
  // that rounding does not exceed it.
  return std::min(std::numbers::pi / 2, 4 * std::asin(std::sqrt(ratio)) * (1 - 1e-9));
}

}  // namespace

Linearizer::Linearizer(double radius, double max_error)
    : radius_(radius), max_error_(max_error), largest_step_(step_of(radius, max_error)) {}

void Linearizer::append_arc(const Zone::Piece& arc, std::vector<Point>& points) {
  if (arc.radius > 0 && arc.radius != radius_) {
    radius_ = arc.radius;
    largest_step_ = step_of(radius_, max_error_);
  }
  double angle = arc_angle(arc);
  auto count = static_cast<std::size_t>(std::max(1.0, std::ceil(angle / largest_step_)));
  double step = angle / static_cast<double>(count);
  Point from{arc.start.x - arc.center.x, arc.start.y - arc.center.y};
  double first = std::atan2(from.y, from.x), distance = std::hypot(from.x, from.y);
  for (std::size_t i = 1; i < count; ++i) {
    double direction = arc.clockwise ? first - static_cast<double>(i) * step : first + static_cast<double>(i) * step;
    points.push_back({arc.center.x + distance * std::cos(direction), arc.center.y + distance * std::sin(direction)});
  }
  points.push_back(arc.end);
  deviation_ = std::max(deviation_, sagitta(radius_, step));
}

std::vector<Point> Linearizer::ring(const Zone& zone, std::uint32_t ring) {
  std::vector<Point> points = {zone.piece(zone.ring_begin(ring)).start};
  for (std::uint32_t e = zone.ring_begin(ring); e < zone.ring_begin(ring + 1); ++e) {
    Zone::Piece piece = zone.piece(e);
    if (piece.kind == Zone::Kind::arc && !is_negligible(piece)) {
      append_arc(piece, points);
    } else {
      points.push_back(piece.end);
    }
  }
  return points;
}

}  // namespace krepl::output
