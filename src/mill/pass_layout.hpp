#pragma once

#include <cstdint>
#include <vector>

#include "krepl/error.hpp"
#include "krepl/terrain.hpp"
#include "mill/line_bodies.hpp"

namespace krepl::mill {

/// The points of the plane whose coordinates have few decimals, as a post writes them; numbers are absolute, places
/// relative to the part's origin.
struct PlaneLattice {
  double unit;
  Point3 origin;  ///< of the part
  Point place(std::int64_t i, std::int64_t j) const {
    return {double(i) * unit - origin.x, double(j) * unit - origin.y};
  }
};

/// A family of parallel lines through lattice points in a direction (p, q) of the lattice, so that places along each of
/// them are lattice points again: the i-th is (i0 + i p, j0 + i q).
struct PassLayout {
  PlaneLattice lattice;
  std::int64_t p = 1, q = 0;
  double step = 0;       ///< distance of lattice points along a pass
  double step_over = 0;  ///< greatest distance of neighbouring passes
  struct Pass {
    std::int64_t i0, j0;       ///< where t is zero
    std::int64_t first, last;  ///< of its places
  };
  std::vector<Pass> passes;

  bool is_along_axis() const { return p == 0 || q == 0; }
  Line line(const Pass& pass) const;
  double angle() const;
};

/// Passes over a part's bounding rectangle and `margin` beyond. Next to walls a path is up to a step off: it is at most
/// a quarter of the tolerance.
PassLayout lay_passes(const Terrain& part, double unit, double degrees, double step_over, double margin,
                      double tolerance);

}  // namespace krepl::mill
