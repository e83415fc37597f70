#include "route/shortest.hpp"

#include "model/radius_check.hpp"
#include "route/ends.hpp"
#include "route/free_space.hpp"
#include "route/taut_search.hpp"

namespace krepl::route {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// The arc that a string turns about between two tangents.
Route::Piece arc_piece(const Obstacles& obstacles, const FreeArc& arc, double radius, const TautStretch& before,
                       const TautStretch& after) {
  Route::Piece piece;
  piece.kind = Route::Kind::arc;
  piece.start = before.end, piece.end = after.start, piece.center = arc.center;
  piece.clockwise = before.clockwise;
  piece.vertex = arc.vertex;
  piece.length = radius * after.sweep;
  const Point at = (before.clockwise ? after.start : before.end) - arc.center;
  piece.clearance = obstacles.nearest_to_arc({arc.center, radius, std::atan2(at.y, at.x), after.sweep}, unlimited);
  return piece;
}

Error closed_off(const Network& network, Point from, Point to, bool from_pocket, bool to_pocket, double radius) {
  const char* how = from_pocket && to_pocket ? "they lie in two different pockets of it"
                    : from_pocket            ? "--from lies in a pocket of it"
                                             : "--to lies in a pocket of it";
  return {ErrorCode::input,
          "no route: a disk of radius " + shown(radius) + " cannot get from " + place_text(network, from) + " to " +
              place_text(network, to) + ", which are in different parts of free space (" + how + ")",
          "", "choose both ends in one part, or use a smaller radius"};
}

}  // namespace

Route::Piece line_piece(const Obstacles& obstacles, Point start, Point end) {
  Route::Piece piece;
  piece.start = start, piece.end = end;
  piece.length = distance(start, end);
  piece.clearance = obstacles.nearest_to_segment(start, end, unlimited);
  return piece;
}

Result<Route> shortest_route(const std::shared_ptr<const Network>& network, const Obstacles& obstacles, double radius,
                             Point from, Point to, const Context& context) {
  const Slack slack = slack_for(*network, radius);
  Result<FreeSpace> space = FreeSpace::build(network, radius, context);
  if (!space) return space.error();
  const auto from_pocket = space->pocket(from), to_pocket = space->pocket(to);
  if (from_pocket != to_pocket)
    return closed_off(*network, from, to, from_pocket.has_value(), to_pocket.has_value(), radius);
  TautSearch search(*space, obstacles, radius, slack);
  Result<std::vector<TautStretch>> stretches = search.run(from, to, context);
  if (!stretches) return stretches.error();
  if (stretches->empty())
    return Error{ErrorCode::computation, "no route was found though both ends are in one part of free space",
                 "from " + place_text(*network, from) + " to " + place_text(*network, to), "please report this input"};
  Route route;
  route.turn_radius = radius;
  route.counters = search.counters();
  for (std::size_t i = 0; i < stretches->size(); ++i) {
    TautStretch& s = (*stretches)[i];
    if (i > 0) {
      const TautStretch& before = (*stretches)[i - 1];
      if (radius * s.sweep > slack.tolerance)
        route.pieces.push_back(arc_piece(obstacles, space->arcs()[before.arc], radius, before, s));
      else
        s.start = before.end;  // the same place but for rounding
    }
    if (distance(s.start, s.end) > slack.tolerance || stretches->size() == 1)
      route.pieces.push_back(line_piece(obstacles, s.start, s.end));
    else
      s.end = s.start;
  }
  if (route.pieces.empty()) route.pieces.push_back(line_piece(obstacles, from, to));
  return route;
}

Result<Route> finish_route(const Network& network, Route route, double radius) {
  const double tolerance = std::max(1e-9 * std::max(network.extent(), radius), 64 * network.resolution());
  for (Route::Piece& piece : route.pieces) {
    route.length += piece.length;
    route.clearance = std::min(route.clearance, piece.clearance);
    if (piece.clearance < radius - tolerance)
      return Error{ErrorCode::computation, "the route comes as near as " + shown(piece.clearance) + " to an obstacle",
                   "between " + place_text(network, piece.start) + " and " + place_text(network, piece.end),
                   "please report this input"};
    for (Point* p : {&piece.start, &piece.end, &piece.center, &piece.control}) *p = *p + network.origin();
  }
  return route;
}

}  // namespace krepl::route
