#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "krepl/error.hpp"
#include "krepl/network.hpp"

namespace krepl::zone {

using Index = std::uint32_t;
inline constexpr Index none = ~Index{0};

/// A network's segments with a radius each, and its vertices once for each radius that meets there. Segments keep the
/// network's numbers; of several parts that share a segment the largest radius counts, for its cigar contains the others.
struct VariedSites {
  std::vector<Point> vertices;             // relative to the network's origin
  std::vector<Network::Segment> segments;  // between them
  std::vector<double> radius;              // per vertex
  std::vector<Index> vertex;               // per vertex: which of the network's it is
  double least = 0, most = 0;
};

/// One radius for each part of the network, all finite and positive. O(n log n).
std::shared_ptr<const VariedSites> vary_sites(const Network& network, std::span<const double> part_radii);

}  // namespace krepl::zone
