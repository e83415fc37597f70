#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace krepl::river {

/// A reach as the hierarchy sees it.
struct Link {
  std::uint32_t from, to;  ///< nodes
  double length;
};

/// Orders, sub-rivers and stems of a directed graph; what the words mean stands at RiverNetwork.
struct Hierarchy {
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  struct SubRiver {
    std::vector<std::uint32_t> links;  // downstream
    double length = 0;
    std::uint32_t downstream = none, stem = none;
  };
  std::vector<bool> closes_cycle;        // per link
  std::vector<std::uint32_t> order;      // per link
  std::vector<std::uint32_t> sub_river;  // per link
  std::vector<SubRiver> sub_rivers;      // the longest first, then by their last link
};

/// Linear time but for sorting.
///
/// Links that close a directed cycle are found by a search from the sources and left aside. The rest has no cycle, so
/// each link has a longest way up to a source and down to a drain. At a node the incoming link with the longest way up
/// goes on in the outgoing one with the longest way down, ties by number; all others end and start there. So the
/// longest way of all is one sub-river, and no sub-river visits a node twice.
Hierarchy make_hierarchy(std::size_t node_count, std::span<const Link> links);

}  // namespace krepl::river
