#include <cmath>

#include "krepl/shape.hpp"
#include "shape/bodies.hpp"
#include "shape/body_union.hpp"
#include "shape/check_options.hpp"
#include "shape/one_sided.hpp"
#include "shape/polygon_border.hpp"
#include "shape/two_sided.hpp"
#include "zone/precision.hpp"
#include "zone/nesting.hpp"
#include "zone/zone_rings.hpp"

namespace krepl {
namespace shape {
namespace {

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

struct Segments {
  using Network = krepl::Network;
  static const Network& straight(const Network& network) { return network; }
  static constexpr auto border_network = shape::border_network;
  static constexpr auto union_border = shape::union_border;
  static constexpr auto outline = shape::outline;
  static constexpr auto rings_by_polygons = zone::rings_by_polygons;
};

}  // namespace
}  // namespace shape

Result<Zone> compute_shape(std::shared_ptr<const Network> network, const ShapeOptions& o, const Context& context) {
  if (Status options = shape::check_options(*network, o); !options) return options.error();
  if (o.side != Side::both) return shape::one_sided(std::move(network), o, context);
  const bool plain = o.distance > 0 && !o.ring && o.cap == Cap::round && o.join == Join::round;
  if (plain) return compute_zone(std::move(network), {o.distance}, context);
  return shape::two_sided<shape::Segments>(std::move(network), o, context);
}

}  // namespace krepl
