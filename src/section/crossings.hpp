#pragma once

#include <functional>
#include <vector>

#include "section/edge_course.hpp"

namespace krepl::section {

/// Where an edge crosses a level or a line.
struct Crossing {
  /// Which faces see it: only the left or only the right one of half-edge 2e, at a wall; else both.
  enum class Side : std::uint8_t { left, right, both };
  Index edge;
  double s;  ///< parameter of the edge's course
  Point3 at;
  Side side;
  bool rising;  ///< from lower to higher, or from right to left of the line, along half-edge 2e
};

/// Appends the places where a function changes its sign along an edge, with s ascending; not negative counts as high.
/// What it is at the ends is given, and holds whatever the function says there. Next to an end where the function is no
/// more than `slack` the crossing is at the end.
void find_crossings(const EdgeCourse& course, Index edge, Crossing::Side side, bool starts_high, bool ends_high,
                    const std::function<double(Point3)>& value, double slack, std::vector<Crossing>& out);

}  // namespace krepl::section
