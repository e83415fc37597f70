#pragma once

#include <algorithm>
#include <cstdint>

#include "krepl/network.hpp"

namespace krepl {

/// Calls visit(u, v) for each segment of a part as it was given, from vertex u to another one, v: with the closing side
/// of a ring, and as often as it stands there.
template <class Visit>
void for_each_segment_of(const Network& network, std::uint32_t part, Visit&& visit) {
  const auto chain = network.part(part);
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    if (chain[i] != chain[i + 1]) visit(chain[i], chain[i + 1]);
  }
  if (network.part_is_ring(part) && chain.size() > 2 && chain.back() != chain.front()) visit(chain.back(), chain.front());
}

/// The network's segment between two vertices that a part joins. O(log n).
inline std::uint32_t find_segment(const Network& network, std::uint32_t u, std::uint32_t v) {
  const auto segments = network.segments();
  const Network::Segment wanted{std::min(u, v), std::max(u, v)};
  const auto found = std::lower_bound(segments.begin(), segments.end(), wanted, [](const auto& s, const auto& t) {
    return s.a != t.a ? s.a < t.a : s.b < t.b;
  });
  return std::uint32_t(found - segments.begin());
}

}  // namespace krepl
