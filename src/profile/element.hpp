#pragma once

#include <cstdint>

#include "krepl/point.hpp"

namespace krepl::profile {

/// The elements a boundary is made of, numbered in their order along it: 2i is the circle about vertex i, 2i + 1 the
/// offset side of segment i. The half-line on the left counts as the offset side of a wall that comes up from below.
using Label = std::uint32_t;
inline constexpr Label left_half_line = ~Label{0};
constexpr bool is_side(Label label) { return (label & 1) != 0; }

/// A piece on the stack: the part of an element's curve from a start up to the start of the next entry. The start is kept
/// as the touching place, not as a rounded point: center of the disk = a + t u + R n, with u = (n.y, -n.x) along the
/// segment (t = 0 for circles). So nothing is lost far from the origin or when R is far below the coordinates.
struct Entry {
  Point a, b;    ///< ends of the segment; a circle has its vertex as a (b is not used)
  Point n;       ///< unit normal at the start; constant along a side
  double t;      ///< where on the segment the disk touches at the start
  Label label;
  float error;   ///< bound on the start's error along the curve, beyond rounding of n and t themselves
};
static_assert(sizeof(Entry) == 64, "one entry, one cache line");

}  // namespace krepl::profile
