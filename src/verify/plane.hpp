#pragma once

#include <cmath>

#include "krepl/point.hpp"

// Plain vector arithmetic of the verifier, in extended precision and on purpose apart from the kernel of the engines.
namespace krepl::verify {

using Real = long double;

struct Vec {
  Real x = 0, y = 0;
  Vec() = default;
  Vec(Real x_, Real y_) : x(x_), y(y_) {}
  Vec(Point p) : x(p.x), y(p.y) {}
};

inline Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y}; }
inline Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y}; }
inline Vec operator*(Real s, Vec a) { return {s * a.x, s * a.y}; }
inline Real dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y; }
inline Real cross(Vec a, Vec b) { return a.x * b.y - a.y * b.x; }
inline Real length(Vec a) { return std::sqrt(dot(a, a)); }
inline Real distance(Vec a, Vec b) { return length(a - b); }
/// a turned by 90 degrees counter-clockwise.
inline Vec left_of(Vec a) { return {-a.y, a.x}; }

/// Coordinates along and across the lines that sections and rays use. They run in a direction of their own, so that the
/// horizontal and vertical sides of ordinary data are not special to them.
inline Vec ray_frame(Vec p) {
  constexpr Real c = 0.957623983796316867786484L, s = 0.288021363197370220776593L;
  return {c * p.x + s * p.y, c * p.y - s * p.x};
}

/// Distance from p to the segment a b, which may have zero length.
inline Real distance_to_segment(Vec p, Vec a, Vec b) {
  const Vec d = b - a;
  const Real square = dot(d, d);
  const Real t = dot(p - a, d);
  if (!(t > 0)) return distance(p, a);
  if (t >= square) return distance(p, b);
  return std::abs(cross(d, p - a)) / std::sqrt(square);
}

/// Axis-parallel box; empty when new.
struct Box {
  Real x0 = HUGE_VALL, y0 = HUGE_VALL, x1 = -HUGE_VALL, y1 = -HUGE_VALL;
  void add(Vec p) {
    x0 = std::fmin(x0, p.x), y0 = std::fmin(y0, p.y);
    x1 = std::fmax(x1, p.x), y1 = std::fmax(y1, p.y);
  }
  void add(const Box& b) { add(Vec(b.x0, b.y0)), add(Vec(b.x1, b.y1)); }
  bool empty() const { return x0 > x1; }
  Box grown(Real by) const {
    Box b = *this;
    b.x0 -= by, b.y0 -= by, b.x1 += by, b.y1 += by;
    return b;
  }
  bool meets(const Box& b) const { return x0 <= b.x1 && b.x0 <= x1 && y0 <= b.y1 && b.y0 <= y1; }
  Vec middle() const { return {(x0 + x1) / 2, (y0 + y1) / 2}; }
  /// Square of the distance from p; zero inside.
  Real square_distance(Vec p) const {
    const Real dx = std::fmax(std::fmax(x0 - p.x, p.x - x1), Real(0));
    const Real dy = std::fmax(std::fmax(y0 - p.y, p.y - y1), Real(0));
    return dx * dx + dy * dy;
  }
};

}  // namespace krepl::verify
