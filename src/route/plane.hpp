#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/vectors.hpp"

/// Vectors of the plane, as the room of routes uses them.
namespace krepl::route {

inline constexpr double turn = 2 * std::numbers::pi;

using vectors::operator+;
using vectors::operator-;
using vectors::operator*;
using vectors::cross;
using vectors::distance;
using vectors::dot;
using vectors::length;

/// To the right of a direction.
inline Point right(Point u) { return {u.y, -u.x}; }

/// An angle in [0, 2 pi).
inline double positive_angle(double a) {
  if (a < 0) a += turn;
  return a >= turn ? a - turn : a;
}

/// The place of segment ab nearest to p.
inline Point nearest_on_segment(Point p, Point a, Point b) {
  const Point d = b - a;
  const double square = dot(d, d);
  if (!(square > 0)) return a;
  const double t = dot(p - a, d) / square;
  if (t <= 0) return a;
  if (t >= 1) return b;
  return a + t * d;
}
inline double distance_to_segment(Point p, Point a, Point b) { return distance(p, nearest_on_segment(p, a, b)); }

/// Zero if they cross.
inline double segment_distance(Point a, Point b, Point c, Point d) {
  const double c_side = cross(b - a, c - a), d_side = cross(b - a, d - a);
  const double a_side = cross(d - c, a - c), b_side = cross(d - c, b - c);
  const bool crosses = ((c_side > 0 && d_side < 0) || (c_side < 0 && d_side > 0)) &&
                       ((a_side > 0 && b_side < 0) || (a_side < 0 && b_side > 0));
  if (crosses) return 0;
  return std::min(std::min(distance_to_segment(a, c, d), distance_to_segment(b, c, d)),
                  std::min(distance_to_segment(c, a, b), distance_to_segment(d, a, b)));
}

}  // namespace krepl::route
