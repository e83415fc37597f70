#include "output/zone_curves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kernel/vectors.hpp"
#include "model/arc_circle.hpp"
#include "zone/arc_turn.hpp"

namespace krepl::output {

namespace {

constexpr double pi = std::numbers::pi;

using namespace vectors;

/// The point at distance radius from center in direction d, which need not be a unit vector.
Point towards(Point center, double radius, Point d) {
  double scale = radius / std::hypot(d.x, d.y);
  return {center.x + scale * d.x, center.y + scale * d.y};
}

/// A full circle's quarter points from `start` on, counter-clockwise, closed.
std::vector<Point> circle_points(const Zone::Piece& circle) {
  Point u = circle.start - circle.center;
  Point c = circle.center;
  return {circle.start, {c.x - u.y, c.y + u.x}, {c.x - u.x, c.y - u.y}, {c.x + u.y, c.y - u.x}, circle.start};
}

/// Halfway along a counter-clockwise arc; of one about an arc of the input by its chord and radius, where these tell.
Point middle_of(const Zone::Piece& arc) {
  if (!arc.from_arc || !zone::is_short_arc(arc)) return arc_middle(arc.center, arc.start, arc.end);
  const Point chord = arc.end - arc.start;
  const double half = std::hypot(chord.x, chord.y) / 2;
  const double height = half * half / (arc.radius + std::sqrt((arc.radius - half) * (arc.radius + half)));
  return {arc.start.x + chord.x / 2 + chord.y / (2 * half) * height,
          arc.start.y + chord.y / 2 - chord.x / (2 * half) * height};
}

Zone::Piece between(Zone::Piece arc, Point start, Point end) {
  arc.start = start, arc.end = end;
  return arc;
}

void halve(std::vector<Point>& ends, const Zone::Piece& arc) {
  std::vector<Point> finer;
  finer.reserve(2 * ends.size());
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    finer.push_back(ends[i]);
    finer.push_back(middle_of(between(arc, ends[i], ends[i + 1])));
  }
  finer.push_back(ends.back());
  ends = std::move(finer);
}

}  // namespace

namespace {

/// A clockwise arc is measured and cut as its reverse.
Zone::Piece counter_clockwise(Zone::Piece arc) {
  if (arc.clockwise) std::swap(arc.start, arc.end);
  arc.clockwise = false;
  return arc;
}

std::vector<Point> as_it_runs(const Zone::Piece& arc, std::vector<Point> points) {
  if (arc.clockwise) std::reverse(points.begin(), points.end());
  return points;
}

}  // namespace

double arc_angle(const Zone::Piece& piece) {
  if (piece.from_arc) return is_negligible(piece) ? 0 : zone::arc_turn(piece);
  const Zone::Piece arc = counter_clockwise(piece);
  if (arc.start == arc.end) return 2 * pi;
  Point u = arc.start - arc.center, v = arc.end - arc.center;
  double angle = std::atan2(cross(u, v), dot(u, v));
  if (angle > 0) return angle;
  // A tiny arc whose ends are rounded may seem to run backwards; the chord then tells it from nearly a full turn.
  return is_negligible(arc) ? 0 : angle + 2 * pi;
}

Point arc_middle(Point center, Point start, Point end) {
  Point u = start - center, v = end - center;
  double radius = (std::hypot(u.x, u.y) + std::hypot(v.x, v.y)) / 2;
  if (dot(u, v) <= 0) {  // between a quarter and three quarters: the chord is long, its normal is exact enough
    Point chord = end - start;
    return towards(center, radius, {chord.y, -chord.x});
  }
  Point sum{u.x + v.x, u.y + v.y};
  if (cross(u, v) < 0) sum = {-sum.x, -sum.y};
  return towards(center, radius, sum);
}

bool is_negligible(const Zone::Piece& arc) {
  if (arc.start == arc.end) return false;
  double size = std::max(std::fabs(arc.start.x), std::fabs(arc.start.y));
  Point chord = arc.end - arc.start;
  return std::max(std::fabs(chord.x), std::fabs(chord.y)) <= 8 * std::numeric_limits<double>::epsilon() * size;
}

std::vector<Point> arc_points(const Zone::Piece& piece) {
  if (piece.clockwise) return as_it_runs(piece, arc_points(counter_clockwise(piece)));
  const Zone::Piece& arc = piece;
  if (arc.start == arc.end) return circle_points(arc);
  Point middle = middle_of(arc);
  if (arc.from_arc && zone::is_short_arc(arc)) return {arc.start, middle, arc.end};
  Point u = arc.start - arc.center, v = arc.end - arc.center;
  if (cross(u, v) >= 0) return {arc.start, middle, arc.end};
  return {arc.start, arc_middle(arc.center, arc.start, middle), middle,
          arc_middle(arc.center, middle, arc.end), arc.end};
}

std::vector<Point> arc_ends(const Zone::Piece& piece, double largest) {
  const Zone::Piece arc = counter_clockwise(piece);
  std::vector<Point> ends = {arc.start, arc.end};
  double angle = arc_angle(arc);
  if (arc.start == arc.end) {
    ends = circle_points(arc);
    angle /= 4;
  }
  for (; angle > largest; angle /= 2) halve(ends, arc);
  return as_it_runs(piece, std::move(ends));
}

std::optional<Zone::Piece> arc_of_input(Point start, Point middle, Point end) {
  const auto circle = model::arc_circle<kernel::quad>(start, middle, end);
  Zone::Piece piece{Zone::Kind::arc, start, end, {}, 0, false, static_cast<double>(circle.radius)};
  piece.center = {static_cast<double>(start.x + circle.to_center_x), static_cast<double>(start.y + circle.to_center_y)};
  piece.clockwise = !circle.left;
  piece.from_arc = true;
  if (!std::isfinite(piece.radius) || piece.radius == 0) return std::nullopt;
  return piece;
}

double piece_length(const Zone::Piece& piece) {
  if (piece.kind == Zone::Kind::arc && !is_negligible(piece)) return piece.radius * arc_angle(piece);
  return std::hypot(piece.end.x - piece.start.x, piece.end.y - piece.start.y);
}

std::vector<CurveRun> ring_runs(const Zone& zone, std::uint32_t ring) {
  std::vector<CurveRun> runs;
  for (std::uint32_t e = zone.ring_begin(ring); e < zone.ring_begin(ring + 1); ++e) {
    Zone::Piece piece = zone.piece(e);
    bool arc = piece.kind == Zone::Kind::arc && !is_negligible(piece);
    if (runs.empty() || runs.back().arc != arc) runs.push_back({arc, {piece.start}});
    std::vector<Point>& points = runs.back().points;
    if (!arc) {
      points.push_back(piece.end);
      continue;
    }
    std::vector<Point> along = arc_points(piece);
    points.insert(points.end(), along.begin() + 1, along.end());
  }
  return runs;
}

RingMeasure measure_ring(const Zone& zone, std::uint32_t ring) {
  RingMeasure measure;
  // Relative to the ring's first point: large coordinates would cancel.
  Point base = zone.piece(zone.ring_begin(ring)).start;
  for (std::uint32_t e = zone.ring_begin(ring); e < zone.ring_begin(ring + 1); ++e) {
    Zone::Piece piece = zone.piece(e);
    measure.area += cross(piece.start - base, piece.end - base) / 2;
    measure.length += piece_length(piece);
    if (piece.kind != Zone::Kind::arc) continue;
    if (piece.from_arc) {
      measure.area += zone::twice_bulge(piece) / 2;
      continue;
    }
    double angle = arc_angle(piece);
    measure.area += (piece.clockwise ? -1 : 1) * piece.radius * piece.radius * (angle - std::sin(angle)) / 2;
  }
  return measure;
}

}  // namespace krepl::output
