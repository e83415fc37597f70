#pragma once

#include <algorithm>

#include "kernel/box_tree.hpp"
#include "kernel/packed_tree.hpp"
#include "route/plane.hpp"

namespace krepl::route {

using kernel::Box;
using PackedTree = kernel::PackedTree<Box>;

/// Distance of a place from a box; zero inside.
inline double distance(Point p, const Box& b) {
  return std::hypot(std::max({b.min_x - p.x, p.x - b.max_x, 0.0}), std::max({b.min_y - p.y, p.y - b.max_y, 0.0}));
}

}  // namespace krepl::route
