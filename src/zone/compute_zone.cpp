#include <algorithm>
#include <optional>

#include "krepl/zone.hpp"
#include "zone/assembly.hpp"
#include "zone/boundary.hpp"
#include "zone/precision.hpp"
#include "zone/zone_rings.hpp"

namespace krepl {
namespace zone {

Result<ZoneRings> zone_rings(const Network& network, const ZoneOptions& options, const Context& context) {
  const double radius = options.radius;
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
    auto found = uncovered_pieces(*result.instance, tree, options.most_candidates, context, result.counters);
    if (!found) return found.error();
    pieces = std::move(*found);
  }
  if (context.cancelled()) return cancelled;
  auto linked = link_pieces(*result.instance, pieces, context);
  if (!linked) return linked.error();
  result.rings = std::move(*linked);
  return result;
}

}  // namespace zone

namespace {

Result<Zone> zone_of_instance(std::shared_ptr<const Network> network, const zone::Instance& instance, double resolution,
                              const Context& context, std::shared_ptr<const zone::VariedSites> varied) {
  const Error cancelled{ErrorCode::cancelled, "cancelled", "", ""};
  ZoneCounters counters;
  std::vector<zone::Piece> pieces;
  {
    const zone::SiteTree tree(instance, context);
    if (context.cancelled()) return cancelled;
    auto found = zone::uncovered_pieces(instance, tree, 0, context, counters);
    if (!found) return found.error();
    pieces = std::move(*found);
  }
  if (context.cancelled()) return cancelled;
  auto linked = zone::link_pieces(instance, pieces, context);
  if (!linked) return linked.error();
  pieces = {};
  return ZoneAssembly::finish(std::move(network), instance, std::move(*linked), resolution, counters, context,
                              std::move(varied));
}

}  // namespace

Result<Zone> compute_zone(std::shared_ptr<const Network> network, const ZoneOptions& options, const Context& context) {
  auto found = zone::zone_rings(*network, options, context);
  if (!found) return found.error();
  return ZoneAssembly::finish(std::move(network), *found->instance, std::move(found->rings), found->resolution,
                              found->counters, context);
}

Result<Zone> compute_zone(std::shared_ptr<const Network> network, std::span<const double> part_radii,
                          const Context& context) {
  if (Status checked = zone::check_part_radii(*network, part_radii); !checked) return checked.error();
  const auto [least, most] = std::minmax_element(part_radii.begin(), part_radii.end());
  if (*least == *most) return compute_zone(std::move(network), ZoneOptions{*most}, context);
  const auto precision = zone::precision_for(*network, *least, *most);
  if (!precision) return precision.error();
  auto sites = zone::vary_sites(*network, part_radii);
  const zone::Instance instance(*network, *sites, precision->effective_radius - *most, precision->resolution, context);
  return zone_of_instance(std::move(network), instance, precision->resolution, context, std::move(sites));
}

}  // namespace krepl
