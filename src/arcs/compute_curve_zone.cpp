#include <algorithm>

#include "arcs/outline.hpp"
#include "arcs/polygon_border.hpp"
#include "krepl/curve_zone.hpp"
#include "shape/check_options.hpp"
#include "shape/two_sided.hpp"
#include "zone/precision.hpp"

namespace krepl {
namespace arcs {
namespace {

struct Curves {
  using Network = CurveNetwork;
  static const krepl::Network& straight(const Network& network) { return network.straight(); }
  static constexpr auto border_network = arcs::border_network;
  static constexpr auto union_border = arcs::union_border;
  static Result<shape::Outline> outline(const Network& network, const ShapeOptions& options, const Context& context) {
    return arcs::outline(network, options, context);
  }
  static constexpr auto rings_by_polygons = arcs::rings_by_polygons;
};

}  // namespace
}  // namespace arcs

Result<Zone> compute_zone(std::shared_ptr<const CurveNetwork> network, const ZoneOptions& options,
                          const Context& context) {
  // A negative radius is none here, though it is a shape.
  const auto precision =
      zone::precision_for(network->extent(), network->straight().resolution(), options.radius, options.radius);
  if (!precision) return precision.error();
  ShapeOptions round;
  round.distance = options.radius;
  return shape::two_sided<arcs::Curves>(std::move(network), round, context);
}

Result<Zone> compute_zone(std::shared_ptr<const CurveNetwork> network, std::span<const double> part_radii,
                          const Context& context) {
  const Network& straight = network->straight();
  if (Status checked = zone::check_part_radii(straight, part_radii); !checked) return checked.error();
  const auto [least, most] = std::minmax_element(part_radii.begin(), part_radii.end());
  if (*least == *most) return compute_zone(std::move(network), ZoneOptions{*most}, context);
  Result<shape::Outline> found = arcs::outline(*network, part_radii, context);
  if (!found) return found.error();
  zone::ShapedRings rings = std::move(found->rings);
  if (straight.has_polygons()) rings = arcs::rings_by_polygons(*network, rings, straight.origin(), false);
  return ZoneAssembly::finish(std::move(network), *most, std::move(rings), found->slack, found->counters, context, *least);
}

Result<Zone> compute_shape(std::shared_ptr<const CurveNetwork> network, const ShapeOptions& o, const Context& context) {
  if (Status options = shape::check_options(network->straight(), o); !options) return options.error();
  if (o.side != Side::both)
    return Error{ErrorCode::usage, "one-sided zones take no arcs", "", "replace the arcs by chords"};
  return shape::two_sided<arcs::Curves>(std::move(network), o, context);
}

}  // namespace krepl
