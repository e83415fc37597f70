#pragma once

#include <cmath>
#include <limits>

#include "kernel/quad.hpp"
#include "profile/element.hpp"

// Where the boundary passes from one element to a later one: the closed forms, for every precision of the ladder.
// Each is written so that no two nearly equal numbers are subtracted but those the input gives (docs/profile.md).
namespace krepl::profile {

using kernel::quad;

template <class Real>
inline constexpr double epsilon = 0x1p-53;
template <>
inline constexpr double epsilon<long double> = std::numeric_limits<long double>::epsilon() / 2;
template <>
inline constexpr double epsilon<quad> = 0x1p-113;

inline double root(double x) { return std::sqrt(x); }
inline long double root(long double x) { return std::sqrt(x); }
inline quad root(quad x) { return kernel::square_root(x); }

template <class Real>
Real magnitude(Real x) {
  return x < 0 ? -x : x;
}
template <class Real>
Real larger(Real x, Real y) {
  return x < y ? y : x;
}
template <class Real>
Real clamped(Real x, Real low, Real high) {
  return x < low ? low : (x > high ? high : x);
}

template <class Real>
struct Vec {
  Real x, y;
  friend Vec operator+(Vec p, Vec q) { return {p.x + q.x, p.y + q.y}; }
  friend Vec operator-(Vec p, Vec q) { return {p.x - q.x, p.y - q.y}; }
  friend Vec operator*(Real s, Vec p) { return {s * p.x, s * p.y}; }
};
template <class Real>
Real dot(Vec<Real> p, Vec<Real> q) {
  return p.x * q.x + p.y * q.y;
}
template <class Real>
Real cross(Vec<Real> p, Vec<Real> q) {
  return p.x * q.y - p.y * q.x;
}
template <class Real>
Real extent(Vec<Real> p) {
  return magnitude(p.x) + magnitude(p.y);
}
template <class Real>
Vec<Real> left_of(Vec<Real> u) {
  return {-u.y, u.x};
}
template <class Real>
Vec<Real> right_of(Vec<Real> n) {
  return {n.y, -n.x};
}
template <class Real>
Vec<Real> difference(Point p, Point q) {
  return {Real(p.x) - Real(q.x), Real(p.y) - Real(q.y)};
}

/// A start on an element (n, t as in Entry); its error along the curve is at most numerator / denominator. A quotient, so
/// that a crossing costs no further division: see settled_error.
template <class Real>
struct Contact {
  Vec<Real> n;
  Real t;
  Real numerator, denominator;
};

/// One of two round bounds that numerator / denominator stays below, or infinity: then the next precision is asked.
/// `scale` is R plus the distance of the two elements' vertices. Random input passes the first by a factor of 8.
inline double settled_error(double numerator, double denominator, double scale) {
  if (numerator <= 0x1p-48 * scale * denominator) return 0x1p-48 * scale;
  if (numerator <= 0x1p-42 * scale * denominator) return 0x1p-42 * scale;
  return std::numeric_limits<double>::infinity();
}

/// Circle about v, then the side of the segment from w along u: d = v - w.
template <class Real>
Contact<Real> circle_to_side(Vec<Real> d, Vec<Real> u, Real length, Real radius) {
  const Real e = Real(4 * epsilon<Real>);
  const Real along = dot(d, u);
  const Real up = dot(d, left_of(u));
  const Real square = up * (2 * radius - up);
  const Real half_chord = square > 0 ? root(square) : Real(0);
  return {left_of(u), clamped(along + half_chord, Real(0), length),
          e * (extent(d) * (magnitude(radius - up) + half_chord) + square), half_chord};
}

/// Side of a segment from v along u, then the circle about w: d = w - v.
template <class Real>
Contact<Real> side_to_circle(Vec<Real> d, Vec<Real> u, Real radius) {
  const Real e = Real(4 * epsilon<Real>);
  const Vec<Real> n = left_of(u);
  const Real up = dot(d, n);
  const Real square = up * (2 * radius - up);
  const Real half_chord = square > 0 ? root(square) : Real(0);
  const Real inverse = 1 / radius;
  return {inverse * ((radius - up) * n - half_chord * u), Real(0),
          e * (extent(d) * (magnitude(radius - up) + half_chord) + square), half_chord};
}

/// Circle about v, then the circle about w: d = w - v.
template <class Real>
Contact<Real> circle_to_circle(Vec<Real> d, Real radius) {
  const Real e = Real(4 * epsilon<Real>);
  const Real square = dot(d, d);
  const Real height = radius * radius - square / 4;
  const Real stretch = height > 0 ? root(height / square) : Real(0);
  const Real inverse = 1 / radius;
  // Squares below the normal range have lost their digits: the next precision has the exponents for them.
  const bool vanished = square < Real(1e-290) && sizeof(Real) == sizeof(double);
  return {inverse * (stretch * left_of(d) - Real(0.5) * d), Real(0), e * radius * radius,
          vanished || !(height > 0) ? Real(0) : root(height)};
}

/// Two sides that share a vertex: the turn between them has this sine and cosine.
template <class Real>
Real along_adjacent_side(Real sine, Real cosine, Real radius) {
  return (radius * sine) / (1 + cosine);
}
/// Below this cosine the formula above loses more digits than its stated error.
inline constexpr double least_adjacent_cosine = -0.875;
inline constexpr double adjacent_error = 64;  // times epsilon R

/// Side of a segment from v along u, then the side of the one from w along u2; d = w - v, gap = w - (end of the first).
template <class Real>
Contact<Real> side_to_side(Vec<Real> d, Vec<Real> gap, Vec<Real> u, Vec<Real> u2, Real length, Real radius) {
  const Real e = Real(8 * epsilon<Real>);
  const Real sine = cross(u, u2);
  const Real cosine = dot(u, u2);
  const Vec<Real> n = left_of(u2);
  if (gap.x == 0 && gap.y == 0 && cosine > Real(least_adjacent_cosine)) {
    const Real t = along_adjacent_side(sine, cosine, radius);
    return {n, clamped(t, Real(0), length), Real(adjacent_error * epsilon<Real>) * radius, Real(1)};
  }
  if (!(sine > e)) {
    // Walls at one place: the later one starts where the earlier ends. Walls on both sides of a slot as wide as the disk:
    // it starts as high as the lower of both tops. Only the last precision may say so; the others report an unbounded error.
    const bool last = epsilon<Real> == epsilon<quad>;
    const Real t = -dot(cosine > 0 ? gap : d, u2);
    return {n, clamped(t, Real(0), length), e * (radius + extent(d)), last ? Real(1) : Real(0)};
  }
  const Real rise = dot(d, left_of(u));
  const Real t = cosine > 0 ? along_adjacent_side(sine, cosine, radius) - rise / sine
                            : (radius * (1 - cosine) - rise) / sine;
  return {n, clamped(t, Real(0), length), e * (radius + extent(d) + magnitude(t)), sine};
}

}  // namespace krepl::profile
