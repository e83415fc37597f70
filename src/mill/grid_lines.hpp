#pragma once

#include <vector>

#include "mill/surface_grid.hpp"

namespace krepl::mill {

/// A polyline in space near the surface; closed if its last point is its first.
using SpaceLine = std::vector<Point3>;

struct GridLineOptions {
  double first = 0, step = 0;  ///< levels are first + k step, k = 0, 1, ...
  /// One for each place of the grid: lines are drawn in cells of which it is the lower left corner. Empty: everywhere.
  const std::vector<char>* cells = nullptr;
};

/// Lines along which a field on the grid (infinite where there is none) has the values of levels, level by level: straight in
/// triangles of the raster, points on its sides, heights between those of their ends.
std::vector<SpaceLine> grid_lines(const SurfaceGrid& grid, const std::vector<double>& field, const GridLineOptions& options);

}  // namespace krepl::mill
