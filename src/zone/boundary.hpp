#pragma once

#include <vector>

#include "krepl/context.hpp"
#include "krepl/zone.hpp"
#include "zone/gaps.hpp"
#include "zone/site_tree.hpp"

namespace krepl::zone {

/// All uncovered pieces of all boundary elements, sorted by element and, within it, by parameter. Empty if cancelled.
/// Expected O(n log n); the elements are independent of each other, so any number of threads gives the same pieces.
std::vector<Piece> uncovered_pieces(const Instance& instance, const SiteTree& tree, const Context& context,
                                    ZoneCounters& counters);

}  // namespace krepl::zone
