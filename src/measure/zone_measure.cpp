#include "measure/zone_measure.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/vectors.hpp"

namespace krepl::measure {

namespace {

using namespace vectors;

struct Piece {
  double length = 0, area = 0;  // area: between the piece and a point of the ring
};

/// An arc by its radius and the angle that it turns, positive to the left.
struct Turn {
  double radius = 0, angle = 0;
};
Turn turn_of(const input::ResultPiece& arc) {
  const double a = distance(arc.start, arc.middle), b = distance(arc.middle, arc.end), c = distance(arc.start, arc.end);
  if (c == 0) return {a / 2, 2 * std::numbers::pi};
  const double area = cross(arc.middle - arc.start, arc.end - arc.middle) / 2;
  const double radius = a * b * c / (4 * std::fabs(area));
  const auto part = [&](double chord) { return 2 * std::asin(std::min(1.0, chord / (2 * radius))); };
  return {radius, std::copysign(part(a) + part(b), area)};
}

Piece measure(const input::ResultPiece& piece, Point from) {
  const double triangle = cross(piece.start - from, piece.end - from) / 2;
  if (!piece.arc) return {distance(piece.start, piece.end), triangle};
  const Turn turn = turn_of(piece);
  if (!std::isfinite(turn.radius)) return {distance(piece.start, piece.end), triangle};
  return {turn.radius * std::fabs(turn.angle),
          triangle + turn.radius * turn.radius * (turn.angle - std::sin(turn.angle)) / 2};
}

/// The area within a ring; its pieces are added to the sums.
double add_ring(const input::ResultRing& ring, ZoneMeasure& sums) {
  double area = 0;
  for (const input::ResultPiece& piece : ring.pieces) {
    const Piece found = measure(piece, ring.pieces.front().start);
    area += found.area;
    sums.length += found.length;
    ++(piece.arc ? sums.arcs : sums.segments);
    (piece.arc ? sums.arc_length : sums.segment_length) += found.length;
    sums.shortest_piece.lower(found.length, piece.start);
  }
  return std::fabs(area);
}

}  // namespace

ZoneMeasure measure_zone(const input::ResultZone& zone) {
  ZoneMeasure sums;
  sums.radius = zone.radius;
  for (const input::ResultPolygon& polygon : zone.polygons) {
    if (polygon.outer.pieces.empty()) continue;
    ++sums.polygons;
    double area = add_ring(polygon.outer, sums);
    for (const input::ResultRing& hole : polygon.holes) {
      if (hole.pieces.empty()) continue;
      ++sums.holes;
      const double hole_area = add_ring(hole, sums);
      sums.smallest_hole.lower(hole_area, hole.pieces.front().start);
      area -= hole_area;
    }
    sums.area += area;
    sums.smallest_polygon.lower(area, polygon.outer.pieces.front().start);
  }
  return sums;
}

ProfileMeasure measure_profile(const std::vector<input::ProfileRecord>& pieces) {
  using Kind = input::ProfileRecord::Kind;
  ProfileMeasure sums;
  bool first = true;
  for (const input::ProfileRecord& piece : pieces) {
    if (piece.kind == Kind::half_line) continue;
    double length = distance(piece.start, piece.end);
    if (piece.kind == Kind::arc) {
      const double radius = distance(piece.start, piece.center);
      length = 2 * radius * std::asin(std::min(1.0, length / (2 * radius)));
    }
    ++(piece.kind == Kind::arc ? sums.arcs : sums.segments);
    (piece.kind == Kind::arc ? sums.arc_length : sums.segment_length) += length;
    sums.shortest_piece.lower(length, piece.start);
    for (const double z : {piece.start.y, piece.end.y}) {
      sums.lowest = first ? z : std::min(sums.lowest, z);
      sums.highest = first ? z : std::max(sums.highest, z);
      first = false;
    }
  }
  return sums;
}

}  // namespace krepl::measure
