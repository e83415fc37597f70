#pragma once

#include <optional>

#include "route/plane.hpp"

namespace krepl::route {

/// A directed circle that a path turns about: the signed radius is positive where it turns counter-clockwise, negative
/// where clockwise, and zero for a place.
struct Wheel {
  Point center;
  double radius = 0;
};

/// The straight way from one wheel to the next.
struct Tangent {
  Point start, end;
  Point direction;
  double length;
};

/// A path that turns counter-clockwise has the wheel's centre on its left, so it leaves at center + radius * right(u)
/// for its direction u, with the sign of the radius. Hence d . right(u) = rA - rB for d = B - A, and u is d turned by
/// asin((rA - rB) / |d|). Nothing if the wheels turn about one centre, or overlap by more than `slack` with opposite
/// senses.
inline std::optional<Tangent> tangent(const Wheel& a, const Wheel& b, double slack) {
  const Point d = b.center - a.center;
  const double apart = length(d), difference = a.radius - b.radius;
  if (!(apart > 0)) {
    if (difference != 0) return std::nullopt;
    return Tangent{a.center, b.center, {1, 0}, 0};
  }
  if (apart < std::abs(difference) - slack) return std::nullopt;
  const double sine = std::clamp(difference / apart, -1.0, 1.0);
  const double reach = std::sqrt(std::max(0.0, (apart - difference) * (apart + difference)));
  const double cosine = reach / apart;
  const Point e = (1 / apart) * d;
  const Point u{e.x * cosine - e.y * sine, e.x * sine + e.y * cosine};
  return Tangent{a.center + a.radius * right(u), b.center + b.radius * right(u), u, reach};
}

}  // namespace krepl::route
