#include "arcs/outline.hpp"

#include <cmath>

#include "arcs/bodies.hpp"
#include "arcs/body_union.hpp"
#include "arcs/curve_locator.hpp"
#include "zone/precision.hpp"

namespace krepl::arcs {
namespace {

/// Another instance is as good as the first; one in which rounding made two decisions contradict each other is not.
constexpr std::uint64_t instances = 4;

Result<shape::Outline> outline_of(const CurveNetwork& network, const ShapeOptions& options, const Radii& radii, const Context& context) {
  const auto precision = zone::precision_for(network.extent(), network.straight().resolution(), radii.least(), radii.most());
  if (!precision) return precision.error();
  for (std::uint64_t seed = 0;; ++seed) {
    shape::Outline result;
    const Bodies bodies(network, options, radii, precision->effective_radius - radii.most(), precision->resolution, seed);
    auto rings = body_union(bodies, precision->resolution, context, result.counters);
    if (!rings) {
      if (rings.error().code == ErrorCode::computation && seed + 1 < instances) continue;
      return rings.error();
    }
    result.rings = std::move(*rings);
    // What is beside an arc beyond its centre touches what is on this side of it there.
    result.rings.touch = bodies.go_beyond_centres();
    result.slack = 2 * bodies.enlargement();
    return result;
  }
}

}  // namespace

Result<shape::Outline> outline(const CurveNetwork& network, const ShapeOptions& options, const Context& context) {
  return outline_of(network, options, Radii(std::abs(options.distance)), context);
}

Result<shape::Outline> outline(const CurveNetwork& network, std::span<const double> part_radii, const Context& context) {
  return outline_of(network, {}, Radii(network, part_radii), context);
}

zone::ShapedRings rings_by_polygons(const CurveNetwork& network, const zone::ShapedRings& rings, Point origin,
                                    bool inside) {
  const CurveLocator polygons(network);
  const Point own = network.straight().origin(), shift{origin.x - own.x, origin.y - own.y};
  return zone::rings_where(rings, [&](Point start) {
    return polygons.is_inside({start.x + shift.x, start.y + shift.y}) == inside;
  });
}

}  // namespace krepl::arcs
