#pragma once

#include <vector>

#include "krepl/context.hpp"
#include "krepl/drop_cutter.hpp"
#include "mill/surface_grid.hpp"

namespace krepl::mill {

struct RestOf {
  double radius = 0;     ///< of the larger tool
  double allowance = 0;  ///< left by both
  double threshold = 0;  ///< what it may leave more than the smaller one
};

/// The places of a grid where the larger ball cannot take off all that is higher than the threshold above what the ball of
/// the grid reaches: 1 there, else 0.
///
/// x, at the threshold above a touched place, is taken off if it is within R of a place where the larger ball is free. Such a place
/// is looked for over a raster, where a somewhat smaller ball tells that there is none; between both by going to and fro between the ball
/// of that radius about x and the larger ball's surface; where none is found, the place counts as rest. False if cancelled.
bool find_rest(const SurfaceGrid& grid, const DropCutter& cutter, const RestOf& options, const Context& context,
               std::vector<char>& rest);

}  // namespace krepl::mill
