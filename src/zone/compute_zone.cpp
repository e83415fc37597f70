#include <optional>

#include "krepl/zone.hpp"
#include "zone/assembly.hpp"
#include "zone/boundary.hpp"
#include "zone/precision.hpp"

namespace krepl {

Result<Zone> compute_zone(std::shared_ptr<const Network> network, const ZoneOptions& options, const Context& context) {
  const auto precision = zone::precision_for(*network, options.radius);
  if (!precision) return precision.error();
  const Error cancelled{ErrorCode::cancelled, "cancelled", "", ""};

  ZoneCounters counters;
  std::optional<zone::Instance> instance(std::in_place, *network, options.radius, precision->effective_radius,
                                         precision->resolution, context);
  std::vector<zone::Piece> pieces;
  {
    const zone::SiteTree tree(*instance, context);
    if (context.cancelled()) return cancelled;
    pieces = zone::uncovered_pieces(*instance, tree, context, counters);
  }
  if (context.cancelled()) return cancelled;
  auto linked = zone::link_pieces(*instance, pieces, context);
  if (!linked) return linked.error();
  pieces = {};
  return ZoneAssembly::finish(std::move(network), *instance, std::move(*linked), precision->resolution, counters,
                              context);
}

}  // namespace krepl
