#pragma once

#include <vector>

#include "krepl/route.hpp"
#include "route/obstacles.hpp"

namespace krepl::route {

/// The widest way along the medial axis, and among the widest the shortest. Relative to the network's origin.
struct AxisRoute {
  double clearance = 0;  ///< least on the axis, obstacles and frame
  Point first, last;     ///< where it comes onto the axis and leaves it
  std::vector<Route::Piece> pieces;
};

/// Errors: no way of at least `radius`; those of VoronoiDiagram::build.
Result<AxisRoute> widest_on_axis(const Network& network, const Obstacles& obstacles, double radius, Point from,
                                 Point to, const Context& context);

/// The same with the ways from and to the ends.
Result<Route> axis_route(const Network& network, const Obstacles& obstacles, double radius, Point from, Point to,
                         const Context& context);

/// The place between an end and its place on the axis that has a clearance; the end itself if it has it.
Point climb_to(const Obstacles& obstacles, Point end, double clearance, Point on_axis);

}  // namespace krepl::route
