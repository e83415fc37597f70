#include "arcs/outline.hpp"
#include "arcs/polygon_border.hpp"
#include "krepl/curve_zone.hpp"
#include "shape/check_options.hpp"
#include "zone/assembly.hpp"

namespace krepl {
namespace arcs {
namespace {

Result<Zone> round_zone(std::shared_ptr<const CurveNetwork> network, double radius, const Context& context) {
  ShapeOptions round;
  round.distance = radius;
  auto found = outline(*network, round, context);
  if (!found) return found.error();
  if (network->straight().has_polygons())
    found->rings = rings_by_polygons(*network, found->rings, network->straight().origin(), false);
  return ZoneAssembly::finish(std::move(network), radius, std::move(found->rings), found->slack, found->counters,
                              context);
}

/// As shape::two_sided of a Network.
Result<Zone> two_sided(std::shared_ptr<const CurveNetwork> network, const ShapeOptions& o, const Context& context) {
  std::shared_ptr<const CurveNetwork> base = network;
  const bool inward = o.distance < 0;
  if (inward) {
    if (Status shrinkable = shape::check_shrinkable(network->straight()); !shrinkable) return shrinkable.error();
    auto border = border_network(network, context);
    if (!border) return border.error();
    if (*border == nullptr) return ZoneAssembly::finish(network, o.distance, {}, 0, {}, context);
    base = std::move(*border);
  }
  auto found = outline(*base, o, context);
  if (!found) return found.error();
  zone::ShapedRings rings = std::move(found->rings);
  if (network->straight().has_polygons())
    rings = rings_by_polygons(*network, rings, base->straight().origin(), inward);
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
}  // namespace arcs

Result<Zone> compute_zone(std::shared_ptr<const CurveNetwork> network, const ZoneOptions& options,
                          const Context& context) {
  return arcs::round_zone(std::move(network), options.radius, context);
}

Result<Zone> compute_shape(std::shared_ptr<const CurveNetwork> network, const ShapeOptions& o, const Context& context) {
  if (Status options = shape::check_options(network->straight(), o); !options) return options.error();
  if (o.side != Side::both)
    return Error{ErrorCode::usage, "one-sided zones take no arcs", "", "replace the arcs by chords"};
  return arcs::two_sided(std::move(network), o, context);
}

}  // namespace krepl
