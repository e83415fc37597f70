#pragma once

#include <cstddef>
#include <vector>

#include "krepl/point.hpp"

namespace krepl::test {

/// A segment with integer ends and integer length (or a point): its offset by a rational radius has rational vertices.
struct ExactSegment {
  long ax, ay, bx, by, length;
};

struct ExactZone {
  std::size_t polygons = 0, holes = 0;
  double area = 0;
};

/// Union of stadiums of radius numerator / denominator as an exact arrangement of segments and circular arcs over the
/// rationals; only the final area is rounded.
ExactZone exact_zone(const std::vector<ExactSegment>& segments, long numerator, long denominator);

/// Outer boundary and holes of a simple polygon (counter-clockwise) grown by `radius`, by CGAL's approximated offset:
/// off the truth by at most `error`.
ExactZone approximate_offset(const std::vector<Point>& polygon, double radius, double error);

}  // namespace krepl::test
