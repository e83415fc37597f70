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
  static constexpr auto outline = arcs::outline;
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

Result<Zone> compute_shape(std::shared_ptr<const CurveNetwork> network, const ShapeOptions& o, const Context& context) {
  if (Status options = shape::check_options(network->straight(), o); !options) return options.error();
  if (o.side != Side::both)
    return Error{ErrorCode::usage, "one-sided zones take no arcs", "", "replace the arcs by chords"};
  return shape::two_sided<arcs::Curves>(std::move(network), o, context);
}

}  // namespace krepl
