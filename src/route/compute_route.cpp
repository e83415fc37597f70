#include "krepl/route.hpp"

#include <cmath>

#include "route/axis.hpp"
#include "route/ends.hpp"
#include "route/free_space.hpp"
#include "route/shortest.hpp"

namespace krepl {
namespace {

using namespace route;

std::optional<Error> refuse(const Network& network, const RouteOptions& options) {
  if (!(options.radius > 0) || !std::isfinite(options.radius))
    return Error{ErrorCode::usage, "the radius is not a positive number", "", "give the radius of the disk"};
  if (!(options.weight >= 0 && options.weight <= 1))
    return Error{ErrorCode::usage, "the weight of clearance is not in 0 .. 1", "", "give 0 for length alone"};
  for (Point p : {options.from, options.to}) {
    const Point local = p - network.origin();
    if (!std::isfinite(local.x) || !std::isfinite(local.y))
      return Error{ErrorCode::usage, "an end of the route is not a finite place", "", "give x,y"};
    if (std::max(std::abs(local.x), std::abs(local.y)) > 0x1p20 * std::max(network.extent(), options.radius))
      return Error{ErrorCode::usage, "an end of the route is more than a million extents away from the obstacles", "",
                   "check its coordinates"};
  }
  return std::nullopt;
}

/// The shortest route with more clearance than the disk needs: out from the ends first, where they have less.
Result<Route> roomy_route(const std::shared_ptr<const Network>& network, const Obstacles& obstacles,
                          const RouteOptions& options, Point from, Point to, const Context& context) {
  Result<AxisRoute> widest = widest_on_axis(*network, obstacles, options.radius, from, to, context);
  if (!widest) return widest.error();
  const double asked = options.radius + options.weight * (std::max(widest->clearance, options.radius) - options.radius);
  const Point start = climb_to(obstacles, from, asked, widest->first),
              end = climb_to(obstacles, to, asked, widest->last);
  Result<Route> route = shortest_route(network, obstacles, asked, start, end, context);
  if (!route) return route;
  if (start != from) route->pieces.insert(route->pieces.begin(), line_piece(obstacles, from, start));
  if (end != to) route->pieces.push_back(line_piece(obstacles, end, to));
  route->widest = widest->clearance;
  return route;
}

}  // namespace

Result<Route> compute_route(std::shared_ptr<const Network> network, const RouteOptions& options,
                            const Context& context) {
  if (const auto error = refuse(*network, options)) return *error;
  const Obstacles obstacles(*network);
  const Point from = options.from - network->origin(), to = options.to - network->origin();
  const double nearest = options.radius - slack_for(*network, options.radius).shrink / 2;
  if (const auto error = refuse_end(obstacles, from, options.radius, nearest, "--from")) return *error;
  if (const auto error = refuse_end(obstacles, to, options.radius, nearest, "--to")) return *error;

  Result<Route> route = Route{};
  if (from == to)
    route->pieces.push_back(line_piece(obstacles, from, to));  // no way is wider than none
  else if (options.prefer == RoutePreference::clearance)
    route = axis_route(*network, obstacles, options.radius, from, to, context);
  else if (options.weight > 0)
    route = roomy_route(network, obstacles, options, from, to, context);
  else
    route = shortest_route(network, obstacles, options.radius, from, to, context);
  if (!route) return route;
  route->radius = options.radius;
  return finish_route(*network, std::move(*route), options.radius);
}

}  // namespace krepl
