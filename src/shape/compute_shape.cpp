#include <cmath>

#include "krepl/shape.hpp"
#include "shape/bodies.hpp"
#include "shape/body_union.hpp"
#include "shape/check_options.hpp"
#include "shape/one_sided.hpp"
#include "shape/polygon_border.hpp"
#include "zone/assembly.hpp"
#include "zone/precision.hpp"
#include "zone/zone_rings.hpp"

namespace krepl {
namespace shape {
namespace {

/// Rings of the zone of all sides, segments and points, and how far apart they are at least.
struct Outline {
  zone::ShapedRings rings;
  double slack = 0;
  ZoneCounters counters;
};

Result<Outline> outline(const Network& network, const ShapeOptions& o, const Context& context) {
  Outline result;
  const double radius = std::abs(o.distance);
  if (o.cap == Cap::round && o.join == Join::round) {
    auto found = zone::zone_rings(network, {radius}, context);
    if (!found) return found.error();
    const auto contracted =
        zone::contract(*found->instance, std::move(found->rings), found->resolution, context, found->counters);
    result = {zone::shaped(*found->instance, contracted), 2 * found->instance->enlargement(), found->counters};
    return result;
  }
  const auto precision = zone::precision_for(network, radius);
  if (!precision) return precision.error();
  const zone::Instance instance(network, radius, precision->effective_radius, precision->resolution, context);
  const Bodies bodies(network, instance, o);
  auto rings = body_union(network, bodies, precision->resolution, context, result.counters);
  if (!rings) return rings.error();
  result.rings = std::move(*rings);
  result.slack = 2 * instance.enlargement();
  return result;
}

Result<Zone> two_sided(std::shared_ptr<const Network> network, const ShapeOptions& o, const Context& context) {
  std::shared_ptr<const Network> base = network;
  const bool inward = o.distance < 0;
  if (inward) {
    if (Status shrinkable = check_shrinkable(*network); !shrinkable) return shrinkable.error();
    auto border = border_network(network, context);
    if (!border) return border.error();
    if (*border == nullptr) return ZoneAssembly::finish(network, o.distance, {}, 0, {}, context);
    base = std::move(*border);
  }
  auto found = outline(*base, o, context);
  if (!found) return found.error();
  zone::ShapedRings rings = std::move(found->rings);
  if (network->has_polygons()) rings = zone::rings_by_polygons(*network, rings, base->origin(), inward);
  if (o.ring) {
    auto border = union_border(*network, *base, context);
    if (!border) return border.error();
    // Outwards the zone is what lies between its rings and the border, inwards the same from the other side.
    rings.append(inward ? *border : zone::reversed(*border));
  } else if (inward) {
    rings = zone::reversed(rings);
  }
  return ZoneAssembly::finish(std::move(base), o.distance, std::move(rings), found->slack, found->counters, context);
}

}  // namespace
}  // namespace shape

Result<Zone> compute_shape(std::shared_ptr<const Network> network, const ShapeOptions& o, const Context& context) {
  if (Status options = shape::check_options(*network, o); !options) return options.error();
  if (o.side != Side::both) return shape::one_sided(std::move(network), o, context);
  const bool plain = o.distance > 0 && !o.ring && o.cap == Cap::round && o.join == Join::round;
  if (plain) return compute_zone(std::move(network), {o.distance}, context);
  return shape::two_sided(std::move(network), o, context);
}

}  // namespace krepl
