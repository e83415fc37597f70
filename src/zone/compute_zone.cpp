#include <optional>

#include "krepl/zone.hpp"
#include "zone/assembly.hpp"
#include "zone/boundary.hpp"
#include "zone/precision.hpp"
#include "zone/zone_rings.hpp"

namespace krepl {
namespace zone {

Result<ZoneRings> zone_rings(const Network& network, double radius, const Context& context) {
  const auto precision = precision_for(network, radius);
  if (!precision) return precision.error();
  const Error cancelled{ErrorCode::cancelled, "cancelled", "", ""};

  ZoneRings result;
  result.resolution = precision->resolution;
  result.instance.emplace(network, radius, precision->effective_radius, precision->resolution, context);
  std::vector<Piece> pieces;
  {
    const SiteTree tree(*result.instance, context);
    if (context.cancelled()) return cancelled;
    pieces = uncovered_pieces(*result.instance, tree, context, result.counters);
  }
  if (context.cancelled()) return cancelled;
  auto linked = link_pieces(*result.instance, pieces, context);
  if (!linked) return linked.error();
  result.rings = std::move(*linked);
  return result;
}

}  // namespace zone

Result<Zone> compute_zone(std::shared_ptr<const Network> network, const ZoneOptions& options, const Context& context) {
  auto found = zone::zone_rings(*network, options.radius, context);
  if (!found) return found.error();
  return ZoneAssembly::finish(std::move(network), *found->instance, std::move(found->rings), found->resolution,
                              found->counters, context);
}

}  // namespace krepl
