#pragma once

#include <functional>
#include <span>

#include "krepl/context.hpp"
#include "krepl/drop_cutter.hpp"
#include "krepl/error.hpp"
#include "krepl/terrain.hpp"

namespace krepl::output {

/// The rectangle over which a ball of some radius can touch a terrain; relative to terrain.origin().
struct SurfaceFrame {
  double min_x, min_y, max_x, max_y;
  double width() const { return max_x - min_x; }
  double height() const { return max_y - min_y; }
};
SurfaceFrame surface_frame(const Terrain& terrain, double radius);

/// Places at the centres of cells that cover the frame, the northernmost row first. `what` names the option to change
/// where they would be too many.
Result<DropCutter::Raster> covering_raster(const SurfaceFrame& frame, double cell_x, double cell_y, const char* what);

/// Rests the ball on all places of the raster, some rows at a time, and hands these over in their order.
Status for_each_strip(const DropCutter& cutter, const DropCutter::Raster& raster, std::size_t rows_multiple,
                      const Context& context,
                      const std::function<Status(std::size_t first_row, std::size_t rows,
                                                 std::span<const DropCutter::Contact>)>& take);

}  // namespace krepl::output
