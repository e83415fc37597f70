#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "krepl/network.hpp"

namespace krepl::shape {

/// The rings of each feature, by number of part.
inline std::map<std::int64_t, std::vector<std::uint32_t>> rings_by_feature(const Network& network) {
  std::map<std::int64_t, std::vector<std::uint32_t>> rings;
  for (std::uint32_t p = 0; p < network.part_count(); ++p)
    if (network.part_is_ring(p)) rings[network.part_feature(p)].push_back(p);
  return rings;
}

}  // namespace krepl::shape
