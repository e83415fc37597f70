#include <algorithm>
#include <cmath>
#include <string>

#include "kernel/vectors.hpp"
#include "krepl/terrain_route.hpp"
#include "model/radius_check.hpp"
#include "route/flight_lattice.hpp"
#include "route/flight_shorten.hpp"

namespace krepl {
namespace {

using namespace vectors;
using route::FlightEnd;
using route::FlightProof;
using route::FlightRules;

std::optional<Error> refuse(const TerrainRouteOptions& options) {
  if (!(options.max_slope > 0))
    return Error{ErrorCode::usage, "the largest slope is not a positive number", "",
                 "give rise over way, 0.2 for 20 %"};
  if (!(options.step >= 0) || std::isinf(options.step))
    return Error{ErrorCode::usage, "the step of the lattice is not a positive number", "",
                 "leave it out for a default"};
  if (std::isnan(options.ceiling)) return Error{ErrorCode::usage, "the ceiling is not a number", "", "give a height"};
  return std::nullopt;
}

/// An end relative to the terrain's origin, at rest if it has no height.
Result<FlightEnd> end_of(const DropCutter& cutter, const TerrainRouteEnd& end, double ceiling, double tolerance,
                         const std::string& name) {
  const Point3 origin = cutter.terrain().origin();
  const std::string where = "at " + shown(end.place.x) + " " + shown(end.place.y);
  const Point local{end.place.x - origin.x, end.place.y - origin.y};
  const DropCutter::Contact contact = cutter.at(local);
  if (!contact.touches())
    return Error{ErrorCode::input, name + " is not over the terrain: the ball touches nothing there", where,
                 "choose a place over the terrain"};
  const double height = end.height ? *end.height - origin.z : contact.height;
  if (!std::isfinite(height))
    return Error{ErrorCode::usage, name + " has a height that is not finite", where, "give x,y or x,y,z"};
  if (height < contact.height - tolerance)
    return Error{ErrorCode::input,
                 name + ": the ball overlaps the terrain: its centre at " + shown(*end.height) + " is " +
                     shown(contact.height - height) + " below where it rests, " + shown(contact.height + origin.z),
                 where, "raise it, or leave out the height"};
  if (height > ceiling + tolerance)
    return Error{ErrorCode::input, name + " is above the ceiling: the ball's centre is at " + shown(height + origin.z),
                 where, "raise the ceiling to that at least"};
  return FlightEnd{local, std::max(height, contact.height), !end.height.has_value()};
}

/// So that the lattice has some 10 000 places, and no more than four to the radius where that is fewer.
double default_step(const DropCutter& cutter) {
  const Point3 low = cutter.terrain().lowest(), high = cutter.terrain().highest();
  const double area =
      std::max(high.x - low.x, 1e-9 * (high.y - low.y)) * std::max(high.y - low.y, 1e-9 * (high.x - low.x));
  return std::max(std::sqrt(area / 10000), cutter.radius() / 4);
}

void measure(TerrainRoute& route, const FlightRules& rules) {
  const std::size_t last = route.points.size() - 2;
  for (std::size_t i = 0; i + 1 < route.points.size(); ++i) {
    const Point3 a = route.points[i], b = route.points[i + 1];
    route.length += distance(a, b);
    route.climb += std::max(b.z - a.z, 0.0);
    const double way = std::hypot(b.x - a.x, b.y - a.y);
    const bool lift = way == 0 && ((i == 0 && rules.from.lifts) || (i == last && rules.to.lifts));
    if (!lift && a != b) route.steepest = std::max(route.steepest, std::abs(b.z - a.z) / way);
  }
}

}  // namespace

Result<TerrainRoute> compute_terrain_route(const DropCutter& cutter, const TerrainRouteOptions& options,
                                           const Context& context) {
  if (const auto error = refuse(options)) return *error;
  if (cutter.cutter().kind() != Cutter::Kind::ball)
    return Error{ErrorCode::usage, "routes over a terrain are those of a ball", "", "give a drop cutter of a ball"};
  const Terrain& terrain = cutter.terrain();
  const Point3 origin = terrain.origin();
  const double tolerance = 1e-9 * std::max(terrain.extent(), cutter.radius());
  FlightRules rules;
  rules.ceiling = options.ceiling - origin.z;
  rules.max_slope = options.max_slope;
  rules.step = options.step > 0 ? options.step : default_step(cutter);
  rules.climb = options.minimise == TerrainRouteOptions::Minimise::climb;
  const Point3 size = terrain.highest() - terrain.lowest();
  if (size.x / rules.step * (size.y / rules.step) > 3e7)
    return Error{ErrorCode::usage, "the lattice would have more than thirty million places", "", "use a larger step"};
  for (auto [end, given, name] :
       {std::tuple{&rules.from, &options.from, "--from"}, std::tuple{&rules.to, &options.to, "--to"}}) {
    Result<FlightEnd> made = end_of(cutter, *given, rules.ceiling, tolerance, name);
    if (!made) return made.error();
    *end = *made;
  }
  rules.ceiling = std::max({rules.ceiling, rules.from.height, rules.to.height});  // within the tolerance

  TerrainRoute route;
  route.radius = cutter.radius();
  FlightProof proof(cutter, tolerance, route.counters);
  route::FlightLattice lattice(cutter, rules, proof, route.counters);
  if (Status surveyed = lattice.survey(context); !surveyed) return surveyed.error();
  Result<std::vector<Point3>> found = lattice.search(context);
  if (!found) return found.error();
  if (found->empty())
    return Error{ErrorCode::input,
                 "no route in a lattice of step " + shown(rules.step) + " under these limits of height and slope", "",
                 "raise the ceiling or the slope, or try a smaller --step"};
  if (found->size() == 1) found->push_back(found->front());
  for (std::size_t i = 0; i + 1 < found->size(); ++i) route.lattice_length += distance((*found)[i], (*found)[i + 1]);
  route.points = route::shorten_flight(std::move(*found), rules, proof, context);
  if (context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  if (!proof.free(route.points, cutter.radius() - tolerance))
    return Error{ErrorCode::computation, "the route could not be proven free", "", "please report this input"};
  route.clearance = proof.clearance(route.points);
  for (Point3& p : route.points) p = p + origin;
  measure(route, rules);
  return route;
}

}  // namespace krepl
