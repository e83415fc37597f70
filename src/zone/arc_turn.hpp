#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "krepl/zone.hpp"

// Arcs whose circle may be far wider than all coordinates (Zone::Piece::from_arc): what depends on the direction of a
// centre far away is told by the chord and the radius.
namespace krepl::zone {

/// True if chord and radius tell all: the arc is a sixth of a turn or less.
inline bool is_short_arc(const Zone::Piece& arc) {
  const Point u{arc.start.x - arc.center.x, arc.start.y - arc.center.y},
      v{arc.end.x - arc.center.x, arc.end.y - arc.center.y};
  const double chord = std::hypot(arc.end.x - arc.start.x, arc.end.y - arc.start.y);
  if (arc.start == arc.end || 2 * chord > arc.radius) return false;
  // The rest of the circle is as far from it as a chord can be; unless the difference is one of rounding.
  const double turn = (u.x * v.y - u.y * v.x) * (arc.clockwise ? -1 : 1);
  return turn > -0x1p-49 * arc.radius * arc.radius;
}

/// The angle that an arc spans, in (0, 2 pi], whichever way it runs; start == end: the full turn.
inline double arc_turn(const Zone::Piece& arc) {
  const double chord = std::hypot(arc.end.x - arc.start.x, arc.end.y - arc.start.y);
  if (is_short_arc(arc)) return 2 * std::asin(std::min(1.0, chord / (2 * arc.radius)));
  const Point from = arc.clockwise ? arc.end : arc.start, to = arc.clockwise ? arc.start : arc.end, c = arc.center;
  const double ux = from.x - c.x, uy = from.y - c.y, vx = to.x - c.x, vy = to.y - c.y;
  const double angle = arc.start == arc.end ? 0 : std::atan2(ux * vy - uy * vx, ux * vx + uy * vy);
  return angle > 0 ? angle : angle + 2 * M_PI;
}

/// angle - sin(angle), which cancels in small ones.
inline double bulge_factor(double angle) {
  if (angle > 0.25) return angle - std::sin(angle);
  const double s = angle * angle;
  return angle * s / 6 * (1 - s / 20 * (1 - s / 42 * (1 - s / 72 * (1 - s / 110))));
}

/// Twice the area between an arc and its chord, negative where the arc runs clockwise.
inline double twice_bulge(const Zone::Piece& arc) {
  return (arc.clockwise ? -1 : 1) * arc.radius * arc.radius * bulge_factor(arc_turn(arc));
}

/// Twice the area on the left of a ring of pieces that tell their radii.
inline double twice_ring_area(const std::vector<Zone::Piece>& ring) {
  double twice = 0;
  const Point base = ring.front().start;
  for (const Zone::Piece& p : ring) {
    twice += (p.start.x - base.x) * (p.end.y - base.y) - (p.start.y - base.y) * (p.end.x - base.x);
    if (p.kind == Zone::Kind::arc) twice += twice_bulge(p);
  }
  return twice;
}

}  // namespace krepl::zone
