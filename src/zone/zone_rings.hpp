#pragma once

#include <optional>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "zone/rings.hpp"

namespace krepl::zone {

/// The linked boundary of a network's zone, polygons not filled, nothing contracted; and what it was decided by.
struct ZoneRings {
  std::optional<Instance> instance;  // refers to the network
  Rings rings;
  double resolution = 0;  // pieces shorter than this are to be contracted
  ZoneCounters counters;
};

/// Errors as compute_zone.
Result<ZoneRings> zone_rings(const Network& network, const ZoneOptions& options, const Context& context);

}  // namespace krepl::zone
