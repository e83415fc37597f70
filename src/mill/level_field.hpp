#pragma once

#include <vector>

#include "krepl/context.hpp"
#include "mill/lifted_cutter.hpp"
#include "mill/raster_contour.hpp"

namespace krepl::mill {

/// How far the places of a raster are from where a cutter may not be on a level; and, where nothing is in the way, how
/// far outside of a rectangle they are. All relative to the part's origin.
class LevelField {
 public:
  /// Heights of the control point over the raster, from which all levels follow. False if cancelled.
  bool build(const LiftedCutter& cutter, const PlaneRaster& raster, Point stock_low, Point stock_high,
             const Context& context);

  /// Distances on a level of the control point, which is free where the surface is not above it.
  void lay(double level);

  const PlaneRaster& raster() const { return raster_; }
  /// Distances, negative where the cutter may not be. Where nothing is in the way: from the middle of the rectangle's
  /// inside, as its sides run.
  const std::vector<double>& distance() const { return distance_; }
  double largest() const { return largest_; }

 private:
  void spread(const std::vector<RasterContour>& borders);

  const LiftedCutter* cutter_ = nullptr;
  PlaneRaster raster_;
  Point low_, high_;
  std::vector<double> height_, distance_;
  double largest_ = 0;
};

}  // namespace krepl::mill
