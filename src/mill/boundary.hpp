#pragma once

#include <vector>

#include "krepl/mill.hpp"
#include "mill/line_bodies.hpp"

namespace krepl::mill {

/// Whether a place is inside of a ring, by the number of sides to the right of it.
bool is_inside(const std::vector<Point>& ring, Point p);

/// Where the control point may be. Places are relative to the part's origin.
class Boundary {
 public:
  Boundary(const MillBoundary& polygons, Point3 origin);

  bool is_everywhere() const { return polygons_.empty(); }
  /// The stretches of a line within any of the polygons, between from and to, in their order. Time linear in the
  /// polygons' sides.
  std::vector<Interval> inside(const Line& line, double from, double to) const;
  /// Whether all of the straight way is inside, but for gaps that rounding explains.
  bool contains(Point from, Point to) const;
  /// The parts of a polyline that are inside.
  std::vector<std::vector<Point>> inside(const std::vector<Point>& polyline) const;

 private:
  std::vector<std::vector<std::vector<Point>>> polygons_;
  double extent_ = 0;
};

/// Errors (usage): a ring of less than three points, a coordinate that is not finite.
Status check_boundary(const MillBoundary& boundary);

}  // namespace krepl::mill
