#include "krepl/sweep.hpp"

namespace krepl {

Result<Zone> compute_zone_auto(std::shared_ptr<const Network> network, const ZoneOptions& options,
                               const Context& context, AutoCounters* counters) {
  // Candidates in the mean that take as long as the sweep takes for an element; rivers, roads and streets have 1 to 6.
  constexpr std::uint64_t too_many = 40;
  AutoCounters own;
  AutoCounters& c = counters != nullptr ? *counters : own;
  c = {};
  ZoneOptions limited = options;
  if (limited.most_candidates == 0) limited.most_candidates = too_many;
  Result<Zone> zone = compute_zone(network, limited, context);
  if (zone.ok() || zone.error().code != ErrorCode::computation) return zone;
  c.given_up = zone.error().text();
  zone = compute_zone_by_sweep(network, {options.radius}, context, &c.sweep);
  c.by_sweep = zone.ok();
  if (zone.ok() || zone.error().code != ErrorCode::computation) return zone;
  return compute_zone(std::move(network), {options.radius}, context);
}

}  // namespace krepl
