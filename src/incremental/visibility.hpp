#pragma once

#include <span>
#include <vector>

#include "incremental/curve.hpp"

namespace krepl::incremental {

/// A function of the ball's centre that must not be negative where a curve is on the boundary. Each is 1-Lipschitz:
/// what it says at a point holds as far around as its value.
struct Condition {
  Vector normal;  ///< of the linear function normal . c - offset
  Real offset = 0;
  Index prism = none;  ///< or: distance from this triangle and what is below it, less R

  Real value(const Parts& parts, Vector c) const {
    return prism == none ? dot(normal, c) - offset : parts.prism_distance(prism, c) - parts.radius();
  }
};

/// That a ball about c from above touches the part's inside: it comes from above, and its contact is not beyond the
/// end.
void add_domain(const Parts& parts, Index part, std::vector<Condition>& conditions);

/// That the triangle does not hide balls that touch `own`, parts or none: where it has the part itself, that the ball
/// does not cut the triangle beside it, else that it is at least R from the triangle and what is below.
void add_cover(const Parts& parts, std::span<const Index> own, Index triangle, std::vector<Condition>& conditions);

/// End of a stretch: somewhere in [low, high], as nothing but the tolerance decides between these. Narrow unless a
/// condition comes to zero along a tangent.
struct StretchEnd {
  Real t, low, high;
};
struct Interval {
  StretchEnd begin, end;
  std::vector<StretchEnd>
      touches;  ///< inside, where a condition comes down to zero and up again: other arcs may pass there
};

/// Where on a curve all conditions hold, up to the tolerance. Every stretch longer than the finest one is found: a part
/// of the curve is left alone only when the values at its ends and its middle, and how much a distance can bend on the
/// way, tell.
std::vector<Interval> where_all_hold(const Parts& parts, const Curve& curve, Real begin, Real end,
                                     const std::vector<Condition>& conditions, const Tolerance& tolerance);

}  // namespace krepl::incremental
