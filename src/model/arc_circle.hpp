#pragma once

#include "kernel/quad.hpp"
#include "krepl/point.hpp"

namespace krepl::model {

/// The circle of an arc.
template <class Real>
struct ArcCircle {
  Real to_center_x, to_center_y;  ///< from the arc's start: near the arc this is exact where a centre far away is not
  Real radius;
  bool left;  ///< the arc turns left
};

/// Through three places that are not in line, or, where start and end are equal, with the middle opposite. The arc may
/// be flat: what rounding does to the radius then hardly shows on the arc.
template <class Real>
ArcCircle<Real> arc_circle(Point start, Point middle, Point end) {
  const Real ux = Real(middle.x) - Real(start.x), uy = Real(middle.y) - Real(start.y);
  ArcCircle<Real> c;
  if (start == end) {
    c.to_center_x = ux / 2, c.to_center_y = uy / 2, c.left = true;
  } else {
    const Real vx = Real(end.x) - Real(start.x), vy = Real(end.y) - Real(start.y);
    const Real turn = ux * vy - uy * vx, uu = ux * ux + uy * uy, vv = vx * vx + vy * vy;
    c.left = turn > 0;
    c.to_center_x = (vy * uu - uy * vv) / (2 * turn);
    c.to_center_y = (ux * vv - vx * uu) / (2 * turn);
  }
  c.radius = kernel::square_root(c.to_center_x * c.to_center_x + c.to_center_y * c.to_center_y);
  return c;
}

}  // namespace krepl::model
