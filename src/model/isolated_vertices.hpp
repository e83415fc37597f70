#pragma once

#include <cstdint>
#include <vector>

#include "krepl/network.hpp"

namespace krepl::model {

/// Vertices at the end of no segment, ascending. Linear time.
inline std::vector<std::uint32_t> isolated_vertices(const Network& network) {
  std::vector<bool> used(network.vertices().size(), false);
  for (const auto& s : network.segments()) used[s.a] = used[s.b] = true;
  std::vector<std::uint32_t> isolated;
  for (std::uint32_t v = 0; v < used.size(); ++v)
    if (!used[v]) isolated.push_back(v);
  return isolated;
}

}  // namespace krepl::model
