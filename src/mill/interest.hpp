#pragma once

#include <vector>

#include "krepl/drop_cutter.hpp"
#include "mill/pass_limits.hpp"

namespace krepl::mill {

/// Where in the plane passes within limits have to cover the surface, on a raster: cells at least half a
/// cell within the boundary, and on shallow ground.
class Interest {
 public:
  /// Over the part's bounding rectangle and the ball's radius beyond, unless there are no limits.
  Interest(const DropCutter& cutter, const PassLimits& limits, double cell);

  bool is_everywhere() const { return cells_.empty(); }
  /// Whether a cell of interest is within a distance in x and y.
  bool has(Point p, double within) const;

 private:
  void mark_inside(const Boundary& boundary);

  double cell_;
  Point first_;
  std::size_t columns_ = 0, rows_ = 0;
  std::vector<char> cells_;
};

}  // namespace krepl::mill
