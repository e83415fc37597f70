#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "krepl/point.hpp"

namespace krepl::mill {

/// The points of space whose coordinates have few decimals: whole numbers of units from `zero`.
struct SpaceLattice {
  double unit;
  Point3 zero;
  using Place = std::array<std::int64_t, 3>;
  Place round(Point3 p) const;
  Point3 place(const Place& p) const {
    return {double(p[0]) * unit + zero.x, double(p[1]) * unit + zero.y, double(p[2]) * unit + zero.z};
  }
};

/// Lattice points of a chain of lines along a polyline: every place of a line is within `within` (2 units at least) of
/// a place of the polyline, in order. From each point the farthest is taken that is found by doubling and halving.
std::vector<SpaceLattice::Place> fit_lines(const std::vector<Point3>& polyline, const SpaceLattice& lattice,
                                           double within);

}  // namespace krepl::mill
