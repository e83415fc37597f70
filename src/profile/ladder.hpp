#pragma once

#include "krepl/profile.hpp"
#include "profile/element.hpp"

// The upper rung of the predicates: what double precision leaves open (sweep.cpp) is decided here from the input's own
// numbers with twice the digits; what is still open is a tie.
namespace krepl::profile {

/// The later element of a question: the side of segment a-b, or (a == b) nothing but the circle about b.
struct Later {
  Point a, b;
};

/// Where `next` starts after the crossing with `p`, on the circle about next.b or on the side next.a-next.b.
struct Start {
  Point n;
  double t;
  float error;
};
Start precise_start(const Entry& p, const Later& next, bool on_circle, double radius, ProfileCounters& counters);

/// Whether the start of p (which follows `before`) lies below the boundary of the segment's own sum: 1 yes, -1 no; a tie
/// counts as yes, so pieces of length zero vanish; but of two walls at one place the earlier one stays.
int precise_covered(const Entry& before, const Entry& p, const Later& next, double radius, ProfileCounters& counters);

/// Whether the side of `next` stays below the curve of p over its whole length, so that the crossing lies on the circle
/// about next.b: 1 yes, -1 no; a tie counts as yes, so sides of length zero do not come to be.
int precise_beyond(const Entry& p, const Later& next, double radius, ProfileCounters& counters);

/// Whether the side of `next` touches the circle of `arc` (at next.a, following `before`) after its start: -1 yes, the arc
/// stays; 1 no; 0 exactly at its start. `tangent`: the arc continues the side `before` smoothly.
int precise_turn(const Entry& before, const Entry& arc, bool tangent, const Later& next, double radius,
                 ProfileCounters& counters);

}  // namespace krepl::profile
