#pragma once

#include <cmath>
#include <limits>
#include <type_traits>

#include "kernel/double_double.hpp"
#include "profile/element.hpp"

// Where the boundary passes from one element to a later one: the closed forms, for every precision of the ladder.
// Each is written so that no two nearly equal numbers are subtracted but those the input gives (docs/profile.md). The one
// exception is circle_to_circle in double precision; the error that it states includes it.
namespace krepl::profile {

using kernel::DoubleDouble;

/// Bound on the relative error of one operation.
template <class Real>
inline constexpr double epsilon = 0x1p-53;
template <>
inline constexpr double epsilon<DoubleDouble> = 0x1p-100;

inline double root(double x) { return std::sqrt(x); }
inline DoubleDouble root(DoubleDouble x) { return square_root(x); }

template <class Real>
Real magnitude(Real x) {
  return x < Real(0.0) ? -x : x;
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
  const Real e = 4 * epsilon<Real>;
  const Real along = dot(d, u);
  const Real up = dot(d, left_of(u));
  const Real square = up * (Real(2.0) * radius - up);
  const Real half_chord = square > Real(0.0) ? root(square) : Real(0.0);
  return {left_of(u), clamped(along + half_chord, Real(0.0), length),
          e * (extent(d) * (magnitude(radius - up) + half_chord) + square), half_chord};
}

/// Side of a segment from v along u, then the circle about w: d = w - v.
template <class Real>
Contact<Real> side_to_circle(Vec<Real> d, Vec<Real> u, Real radius) {
  const Real e = 4 * epsilon<Real>;
  const Vec<Real> n = left_of(u);
  const Real up = dot(d, n);
  const Real square = up * (Real(2.0) * radius - up);
  const Real half_chord = square > Real(0.0) ? root(square) : Real(0.0);
  const Real inverse = Real(1.0) / radius;
  return {inverse * ((radius - up) * n - half_chord * u), Real(0.0),
          e * (extent(d) * (magnitude(radius - up) + half_chord) + square), half_chord};
}

/// Length and direction, whatever the exponents: squares of tiny steps would vanish.
template <class Real>
struct Frame {
  Vec<Real> u;
  Real length;
};
struct NearOne {
  Vec<DoubleDouble> vec;  ///< divided by power
  double power;
};
inline NearOne near_one(Vec<DoubleDouble> d) {
  const double power = std::ldexp(1.0, std::ilogb(std::fmax(std::fabs(d.x.high), std::fabs(d.y.high))));
  return {{{d.x.high / power, d.x.low / power}, {d.y.high / power, d.y.low / power}}, power};
}
inline Frame<DoubleDouble> frame_of(Vec<DoubleDouble> d) {
  const NearOne scaled = near_one(d);
  const DoubleDouble length = root(dot(scaled.vec, scaled.vec));
  return {(1.0 / length) * scaled.vec, length * scaled.power};
}

/// Circle about v, then the circle about w: d = w - v.
inline Contact<double> circle_to_circle(Vec<double> d, double radius) {
  const double square = dot(d, d);
  const double height = radius * radius - square / 4;
  const double stretch = height > 0 ? std::sqrt(height / square) : 0;
  const double inverse = 1.0 / radius;
  // The error is that of the root of height, which is at least height / R. Vanished squares are for the next rung.
  const bool usable = height > 0 && square > 1e-290;
  return {inverse * (stretch * left_of(d) - 0.5 * d), 0, 4 * epsilon<double> * radius * radius,
          usable ? height * inverse : 0};
}
inline Contact<DoubleDouble> circle_to_circle(Vec<DoubleDouble> d, DoubleDouble radius) {
  const Frame<DoubleDouble> f = frame_of(d);
  const DoubleDouble half = f.length * 0.5;
  const DoubleDouble square = (radius - half) * (radius + half);
  const DoubleDouble height = square > 0.0 ? root(square) : 0.0;
  const DoubleDouble inverse = 1.0 / radius;
  return {inverse * (height * left_of(f.u) - 0.5 * d), 0.0, 4 * epsilon<DoubleDouble> * radius * radius, height};
}

/// Two sides that share a vertex: the turn between them has this sine and cosine.
template <class Real>
Real along_adjacent_side(Real sine, Real cosine, Real radius) {
  return (radius * sine) / (Real(1.0) + cosine);
}
/// Below this cosine the formula above loses more digits than its stated error.
inline constexpr double least_adjacent_cosine = -0.875;
inline constexpr double adjacent_error = 64;  // times epsilon R

/// Side of a segment from v along u, then the side of the one from w along u2; d = w - v, gap = w - (end of the first).
template <class Real>
Contact<Real> side_to_side(Vec<Real> d, Vec<Real> gap, Vec<Real> u, Vec<Real> u2, Real length, Real radius) {
  const Real e = 8 * epsilon<Real>;
  const Real sine = cross(u, u2);
  const Real cosine = dot(u, u2);
  const Vec<Real> n = left_of(u2);
  if (gap.x == Real(0.0) && gap.y == Real(0.0) && cosine > Real(least_adjacent_cosine)) {
    const Real t = along_adjacent_side(sine, cosine, radius);
    return {n, clamped(t, Real(0.0), length), Real(adjacent_error * epsilon<Real>) * radius, Real(1.0)};
  }
  if (!(sine > e)) {
    // Walls at one place: the later one starts where the earlier ends. Walls on both sides of a slot as wide as the disk:
    // it starts as high as the lower of both tops. Only the last precision may say so; the others report an unbounded error.
    const bool last = std::is_same_v<Real, DoubleDouble>;
    const Real t = -dot(cosine > Real(0.0) ? gap : d, u2);
    return {n, clamped(t, Real(0.0), length), e * (radius + extent(d)), last ? Real(1.0) : Real(0.0)};
  }
  const Real rise = dot(d, left_of(u));
  const Real t = cosine > Real(0.0) ? along_adjacent_side(sine, cosine, radius) - rise / sine
                            : (radius * (Real(1.0) - cosine) - rise) / sine;
  return {n, clamped(t, Real(0.0), length), e * (radius + extent(d) + magnitude(t)), sine};
}

}  // namespace krepl::profile
