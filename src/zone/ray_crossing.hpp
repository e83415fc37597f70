#pragma once

#include "kernel/vectors.hpp"
#include "krepl/network.hpp"

namespace krepl::zone {

/// True if the ray from a place to the left crosses a segment from p to q an odd number of times. Places on it count as left of
/// it, whichever way it runs, or as above it if it is level.
inline bool ray_crosses_segment(Point p, Point q, Point from) {
  const double turn = vectors::cross(p, q, from);
  return (p.y <= from.y) != (q.y <= from.y) && (p.y < q.y ? turn < 0 : turn > 0);
}

/// The same of an arc, or of a circle if p == q: its chord, and once more where the place is between chord and arc.
/// `in_circle`: whether the place is inside the arc's circle.
inline bool ray_crosses_arc(Point p, Point q, bool turns_left, bool in_circle, Point from) {
  const double turn = vectors::cross(p, q, from);
  // A left turn bulges to the right of its chord.
  const bool right = turn < 0 || (turn == 0 && (p.y == q.y ? q.x < p.x : !(p.y < q.y)));
  const bool beyond = p == q || turns_left == right;
  return ray_crosses_segment(p, q, from) != (in_circle && beyond);
}

}  // namespace krepl::zone
