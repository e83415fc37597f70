#include "arcs/bodies.hpp"
#include "arcs/body_union.hpp"
#include "arcs/curve_locator.hpp"
#include "krepl/curve_zone.hpp"
#include "zone/assembly.hpp"
#include "zone/precision.hpp"

namespace krepl {
namespace arcs {
namespace {

/// Rings inside a polygon bound what is filled. They keep a distance of R from its border, so any place of a ring
/// decides.
zone::ShapedRings drop_rings_inside_polygons(const CurveNetwork& network, zone::ShapedRings rings) {
  const CurveLocator polygons(network);
  zone::ShapedRings kept;
  for (Index r = 0; r < rings.ring_count(); ++r) {
    const auto first = rings.piece.begin() + rings.begin[r], last = rings.piece.begin() + rings.begin[r + 1];
    if (polygons.is_inside(first->start)) continue;
    kept.piece.insert(kept.piece.end(), first, last);
    kept.close();
  }
  return kept;
}

/// Another instance is as good as the first; one in which rounding made two decisions contradict each other is not.
constexpr std::uint64_t instances = 4;

}  // namespace
}  // namespace arcs

Result<Zone> compute_zone(std::shared_ptr<const CurveNetwork> network, const ZoneOptions& options,
                          const Context& context) {
  const double radius = options.radius;
  const auto precision = zone::precision_for(network->extent(), network->straight().resolution(), radius, radius);
  if (!precision) return precision.error();
  const double enlargement = precision->effective_radius - radius;
  for (std::uint64_t seed = 0;; ++seed) {
    ZoneCounters counters;
    const arcs::Bodies bodies(*network, radius, precision->effective_radius, precision->resolution, seed);
    auto rings = arcs::body_union(bodies, precision->resolution, context, counters);
    if (!rings) {
      if (rings.error().code == ErrorCode::computation && seed + 1 < arcs::instances) continue;
      return rings.error();
    }
    if (network->straight().has_polygons()) *rings = arcs::drop_rings_inside_polygons(*network, std::move(*rings));
    return ZoneAssembly::finish(network, radius, std::move(*rings), 2 * enlargement, counters, context);
  }
}

}  // namespace krepl
