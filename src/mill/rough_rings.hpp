#pragma once

#include <vector>

#include "mill/level_field.hpp"

namespace krepl::mill {

/// A connected part of a level that is at least so far from what is in the way, and its border as rings (open where the
/// raster ends), what is farther on the left.
struct RingNode {
  std::vector<std::size_t> children;  ///< parts of it that are farther
  std::vector<RasterContour> rings;
  std::size_t farthest = 0;  ///< place of the raster
};

/// Rings at the distances first + k spacing, k = 0, 1, ..., as a forest; `roots` are the parts for k = 0. Inside of the
/// last ring there is one half a spacing farther if that is possible, so that no place is farther than that from a
/// ring.
struct RingForest {
  std::vector<RingNode> nodes;
  std::vector<std::size_t> roots;
};
RingForest find_rings(const LevelField& field, double first, double spacing);

}  // namespace krepl::mill
