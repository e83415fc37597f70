#pragma once

#include <vector>

#include "krepl/context.hpp"
#include "krepl/owners.hpp"
#include "voronoi/extract.hpp"
#include "voronoi/owner_lobes.hpp"

namespace krepl::voronoi {

struct OwnerRequest {
  double max_error = 0;   ///< of chords of parabolas
  double resolution = 0;  ///< rings that enclose less than this times their length are dropped
};

/// The shares of all owners within the instance's radius, by owner; those without any are left out. Rings follow the
/// borders between owners and the zone's boundary; what both sides of a border have is computed once.
/// ErrorCode::computation if a border does not close.
Result<std::vector<OwnerZone>> owner_zones(const Network& network, const Diagram& diagram, const Instance& instance,
                                           const OwnerLobes& lobes, const OwnerRequest& request, const Context& context);

}  // namespace krepl::voronoi
