#include "output/linear.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "output/zone_curves.hpp"
#include "zone/arc_turn.hpp"

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
  if (arc.from_arc) return append_arc_of_input(arc, points);
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

/// Counts from the start: the centre may be far away, and rounded. Clockwise the zone is outside the circle, so that the
/// lines go along tangents: chords would leave it, and could meet another part of the boundary.
void Linearizer::append_arc_of_input(const Zone::Piece& arc, std::vector<Point>& points) {
  const double angle = arc_angle(arc), r = arc.radius;
  // The corner of two tangents deviates by up to 1.42 times as much as a chord.
  const double largest = arc.clockwise ? step_of(r, max_error_ / 1.5) : largest_step_;
  const auto count = static_cast<std::size_t>(std::max(1.0, std::ceil(angle / largest)));
  const double step = angle / static_cast<double>(count), sense = arc.clockwise ? -1 : 1;
  Point along{sense * (arc.center.y - arc.start.y) / r, sense * (arc.start.x - arc.center.x) / r};  // where it starts
  if (zone::is_short_arc(arc)) {
    const double x = arc.end.x - arc.start.x, y = arc.end.y - arc.start.y, chord = std::hypot(x, y);
    const double c = std::cos(angle / 2) / chord, s = -sense * std::sin(angle / 2) / chord;
    along = {x * c - y * s, x * s + y * c};
  }
  const auto place = [&](double ahead, double aside) {  // the latter towards the centre
    return Point{arc.start.x + along.x * ahead - sense * along.y * aside, arc.start.y + along.y * ahead + sense * along.x * aside};
  };
  const double stretch = arc.clockwise ? 1 / std::cos(step / 2) : 1;
  for (std::size_t i = arc.clockwise ? 0 : 1; i < count; ++i) {
    const double turn = (static_cast<double>(i) + (arc.clockwise ? 0.5 : 0)) * step, half = std::sin(turn / 2);
    // A tangent corner is further out than the arc's place by what follows from the half step.
    const double out = r * (stretch - 1);
    points.push_back(place(r * std::sin(turn) + out * std::sin(turn), 2 * r * half * half - out * std::cos(turn)));
  }
  points.push_back(arc.end);
  deviation_ = std::max(deviation_, sagitta(r, step) * stretch);
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
