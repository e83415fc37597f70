#pragma once

#include "zone/instance.hpp"

namespace krepl::zone {

/// The point where the boundary leaves element `from` for element `to`, relative to the network's origin. Evaluated in double
/// precision where that is well conditioned, in quadruple precision of the moved vertices where it is not.
Point crossing(const Instance& instance, Index from, Index to);

/// Whether the arc on the circle of an isolated vertex from crossing (before, circle) counter-clockwise to crossing
/// (circle, after) is longer than a half circle. Decided in quadruple precision.
bool is_long_arc(const Instance& instance, Index before, Index circle, Index after);

}  // namespace krepl::zone
