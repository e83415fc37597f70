#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "krepl/point.hpp"

namespace krepl::mill {

/// Places of the plane in rows, numbered row by row.
struct PlaneRaster {
  Point first;
  double step = 0;
  std::size_t columns = 0, rows = 0;
  std::size_t size() const { return columns * rows; }
  Point place(std::size_t v) const {
    return {first.x + double(v % columns) * step, first.y + double(v / columns) * step};
  }
};

/// A polyline between places of a raster that are high, on its left, and others; closed if its last point is its first.
struct RasterContour {
  std::vector<Point> points;
  std::size_t high = 0;  ///< one of the high places on its left
  bool is_closed() const { return points.size() > 3 && points.front() == points.back(); }
};

/// All of them, in the order of the raster. `crossing(v, w)`: where the way from the high place v to its neighbour w,
/// which is not high, leaves what is high. High places that touch only diagonally are apart.
std::vector<RasterContour> raster_contours(const PlaneRaster& raster, const std::vector<char>& is_high,
                                           const std::function<Point(std::size_t, std::size_t)>& crossing);

}  // namespace krepl::mill
