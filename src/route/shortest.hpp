#pragma once

#include "krepl/route.hpp"
#include "route/obstacles.hpp"

namespace krepl::route {

/// The shortest route of a disk between two free places, relative to the network's origin; sets everything but
/// Route::radius and Route::widest. Precondition: obstacles are not nearer to the ends than slack_for() allows. Errors:
/// as compute_route.
Result<Route> shortest_route(const std::shared_ptr<const Network>& network, const Obstacles& obstacles, double radius,
                             Point from, Point to, const Context& context);

/// The line between two places, with its clearance.
Route::Piece line_piece(const Obstacles& obstacles, Point start, Point end);

/// Sums up lengths and clearances, and moves all pieces from the network's origin to absolute coordinates. Error if an
/// obstacle is nearer than `radius` by more than 1e-9 S.
Result<Route> finish_route(const Network& network, Route route, double radius);

}  // namespace krepl::route
