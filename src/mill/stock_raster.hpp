#pragma once

#include <cstdint>
#include <vector>

#include "krepl/cutter.hpp"
#include "mill/raster_contour.hpp"

namespace krepl::mill {

/// Stock as heights over a raster, as a tool takes it off on its way. Heights are those of the tool's tip; relative to
/// the part's origin.
class StockRaster {
 public:
  /// A block over a rectangle, up to `top`; nothing beyond it.
  StockRaster(const PlaneRaster& raster, Point low, Point high, double top, const Cutter& cutter);

  /// The tool with its tip there takes off what it meets.
  void cut(Point p, double tip);
  /// Also on the way between two places.
  void cut(Point from, double from_tip, Point to, double to_tip);
  /// Whether there is anything to take off, of more than `least`.
  bool is_cut(Point p, double tip, double least) const;
  /// The least height of the tip at which nothing is taken off within two steps of the place.
  double clear_height(Point p) const;

 private:
  struct Offset {
    std::int64_t x, y;
    double height;  // of the tool's lower side above its tip
  };
  template <class Visit>
  void visit(Point p, const std::vector<Offset>& offsets, const Visit& visit) const;

  PlaneRaster raster_;
  std::vector<double> top_;
  std::vector<Offset> tool_, wider_;
};

}  // namespace krepl::mill
