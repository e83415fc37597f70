#pragma once

#include <limits>

namespace krepl::free {

/// How far away an obstacle is, and how fast that grows, per unit of t.
struct Approach {
  double distance, slope;
};

/// The distance from a convex obstacle is a convex function of t along a straight motion. So Newton's iteration from
/// the left never passes the root: the tangent lies below the function.
inline constexpr int most_steps = 100;  // each at least halves what is left, even where motion and obstacle only touch
inline constexpr double never = std::numeric_limits<double>::infinity();

/// The t in [0, limit] at which the distance has fallen to `level` (to within `noise` above it), or `never`; after
/// `steps` steps a lower bound of it.
template <class Measure>
double fall_to(const Measure& measure, double level, double noise, double limit, int steps = most_steps) {
  double t = 0;
  for (int i = 0; i < steps; ++i) {
    const Approach at = measure(t);
    const double gap = at.distance - level;
    if (gap <= noise) return t;
    if (!(at.slope < 0)) return never;
    const double next = t + gap / -at.slope;
    if (!(next <= limit)) return never;
    if (next == t) return t;
    t = next;
  }
  return t;
}

/// The t in [0, limit] at which the distance is `radius` and after which it falls below radius - tolerance: touching
/// alone, to within the tolerance, is no contact. `never` if there is none.
template <class Measure>
double first_cut(const Measure& measure, double radius, double tolerance, double limit) {
  // Obstacles are not cut before they are cut deeply: the motion's end counts too.
  if (fall_to(measure, radius - tolerance, tolerance / 4, 1) == never) return never;
  return fall_to(measure, radius, tolerance / 16, limit);
}

}  // namespace krepl::free
