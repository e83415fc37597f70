#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "verify/plane.hpp"

namespace krepl::verify {

/// A circular arc from a to b whose circle may be far wider than all coordinates: places count from a, the centre by
/// the way to it, and what would be a difference of two lengths near the radius is a quotient.
struct CircularArc {
  Vec a, b;       ///< equal: the full circle
  Vec to_centre;  ///< from a
  Real r = 0;
  bool left = true;   ///< it turns left from a to b
  bool wide = false;  ///< more than half a turn

  bool full() const { return a.x == b.x && a.y == b.y; }

  /// A sixth of a turn or less: told by chords, without a look at the centre.
  bool is_short() const { return !wide && !full() && length(b - a) <= r; }

  /// Through three places; nothing where they are in line or coincide, but for a == b.
  static std::optional<CircularArc> through(Vec a, Vec m, Vec b) {
    CircularArc arc{a, b, {}, 0, true, true};
    const Vec u = m - a, v = b - a;
    if (arc.full()) {
      arc.to_centre = 0.5L * u;
    } else {
      const Real twice = 2 * cross(u, v), uu = dot(u, u), vv = dot(v, v);
      arc.left = twice > 0;
      arc.wide = dot(u, b - m) < 0;
      arc.to_centre = {(v.y * uu - u.y * vv) / twice, (u.x * vv - v.x * uu) / twice};
    }
    arc.r = length(arc.to_centre);
    if (!std::isfinite(arc.r) || arc.r == 0) return std::nullopt;
    return arc;
  }

  /// From a over m to b about the centre of another arc. The circle is the one through a.
  static CircularArc about(const CircularArc& other, Vec a, Vec m, Vec b) {
    CircularArc arc{a, b, (other.a - a) + other.to_centre, 0, true, false};
    const Real r = arc.r = length(arc.to_centre);
    const Vec chord = b - a, u = m - a;
    if (arc.full()) {
      arc.left = other.left, arc.wide = true;
      return arc;
    }
    // An arc may be so short that rounding hides the order of its three points: it is the short way round then, and has
    // its centre on the side that it turns to.
    arc.wide = length(chord) + length(u) > 1e-6L * r && dot(u, b - m) < 0;
    arc.left = length(chord) > r ? cross(u, chord) > 0 : (cross(chord, arc.to_centre) > 0) != arc.wide;
    return arc;
  }

  /// |p - centre| - r.
  Real off_circle(Vec p) const {
    const Vec v = p - a;
    return (dot(v, v) - 2 * dot(v, to_centre)) / (length(v - to_centre) + r);
  }
  /// True if p is seen from the centre in a direction that the arc spans.
  bool spans(Vec p) const {
    if (full()) return true;
    const Vec v = p - a, e = b - a;
    const Real sense = left ? 1 : -1;
    const Real after_a = sense * -cross(to_centre, v), before_b = sense * cross(to_centre, v - e) + sense * cross(v, e);
    return wide ? after_a >= 0 || before_b >= 0 : after_a >= 0 && before_b >= 0;
  }
  Real distance(Vec p) const {
    if (spans(p)) return std::abs(off_circle(p));
    return std::min(verify::distance(p, a), verify::distance(p, b));
  }
  /// The signed angle that it spans, counter-clockwise positive.
  Real sweep() const {
    const Real sense = left ? 1 : -1, two_pi = 6.283185307179586476925286766559005768L;
    return full() ? sense * two_pi : sense * angle_to(b);
  }
  /// The angle that it has turned through at one of its places, from 0 on.
  Real angle_to(Vec p) const {
    const Real sense = left ? 1 : -1, two_pi = 6.283185307179586476925286766559005768L;
    if (is_short()) return 2 * std::asin(std::min(Real(1), length(p - a) / (2 * r)));
    const Vec u = Real(-1) * to_centre, v = p - a - to_centre;
    const Real angle = sense * std::atan2(cross(u, v), dot(u, v));
    return angle < 0 ? angle + two_pi : angle;
  }
  Vec at(Real t) const {
    if (!is_short()) return a + to_centre + turned(Real(-1) * to_centre, t * sweep());
    const Real s = sweep();
    return a + (std::sin(t * s / 2) / std::sin(s / 2)) * turned(b - a, -(1 - t) * s / 2);
  }
  /// Unit normal at the fraction t, to the right of its course.
  Vec normal(Real t) const {
    const Vec out = (1 / r) * turned(Real(-1) * to_centre, t * sweep());
    return left ? out : Real(-1) * out;
  }
  /// Highest (sign 1) or lowest place of the circle, from a.
  Vec pole(Real sign) const {
    const Vec w = to_centre;
    return {w.x, sign * w.y < 0 ? w.x * w.x / (sign * r - w.y) : w.y + sign * r};
  }
  Box box() const {
    Box result;
    result.add(a), result.add(b);
    const Real half = verify::distance(a, b) / 2;
    if (!wide) return result.grown(half * half / r);
    result.add(a + to_centre);
    return result.grown(r);
  }
  /// Appends where the circle of radius r + offset about the centre is at height y.
  void crossings(Real y, Real offset, std::vector<Real>& out) const {
    const Real dy = y - a.y;
    const Real product = dy * dy - 2 * dy * to_centre.y - offset * (2 * r + offset);
    const Real square = to_centre.x * to_centre.x - product;
    if (square < 0) return;
    const Real large = to_centre.x + std::copysign(std::sqrt(square), to_centre.x);
    out.push_back(a.x + large);
    out.push_back(large != 0 ? a.x + product / large : a.x);
  }
  /// The places on its ends' rays from the centre at height y.
  void wall_crossings(Real y, std::vector<Real>& out) const {
    for (const Vec& end : {a, b}) {
      const Vec d = to_centre - (end - a);
      if (d.y != 0) out.push_back(end.x + (y - end.y) * (d.x / d.y));
    }
  }
  CircularArc in_ray_frame() const {
    CircularArc arc = *this;
    arc.a = ray_frame(a), arc.b = ray_frame(b), arc.to_centre = ray_frame(to_centre);
    return arc;
  }

 private:
  static Vec turned(Vec v, Real angle) {
    const Real c = std::cos(angle), s = std::sin(angle);
    return {c * v.x - s * v.y, s * v.x + c * v.y};
  }
};

}  // namespace krepl::verify
