#pragma once

#include <vector>

#include "krepl/section.hpp"

namespace krepl::mill {

/// A polyline along contours of one level, relative to the part's origin; closed if its last point is its first.
using LevelLine = std::vector<Point>;

/// Points of a closed contour, without the first again at the end, and whether the segment to the next point is steep.
struct LevelRing {
  std::vector<Point> points;
  std::vector<char> is_steep;

  void reverse();
};

struct LevelLineOptions {
  double flatten = 0;     ///< of the polyline from the contour
  double smallest = 0;    ///< points nearer to each other are one
  bool reversed = false;  ///< the higher side on the right
  double steep = 0;       ///< only what is as steep as that, radians
};

/// The rings of a contour as polylines: outer rings in their order, each followed by what is inside of it.
std::vector<LevelRing> level_rings(const Contour& contour, const Surface& surface, const LevelLineOptions& options);

/// What is steep of rings, in their order. Each line starts near the end of the one before, the first near `at`, which becomes
/// the end of the last. Rings of less than three points are left out and counted.
std::vector<LevelLine> level_lines(std::vector<LevelRing>&& rings, Point& at, std::size_t& skipped);

}  // namespace krepl::mill
