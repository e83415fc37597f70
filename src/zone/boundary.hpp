#pragma once

#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/zone.hpp"
#include "zone/gaps.hpp"
#include "zone/site_tree.hpp"

namespace krepl::zone {

/// All uncovered pieces of all boundary elements, sorted by element and, within it, by parameter. Expected O(n log n); the
/// elements are independent of each other, so any number of threads gives the same pieces. Errors: cancelled;
/// ErrorCode::computation if there are more candidates than ZoneOptions::most_candidates allows.
Result<std::vector<Piece>> uncovered_pieces(const Instance& instance, const SiteTree& tree, std::uint64_t most_candidates,
                                            const Context& context, ZoneCounters& counters);

}  // namespace krepl::zone
