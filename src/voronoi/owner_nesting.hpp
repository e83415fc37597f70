#pragma once

#include <vector>

#include "krepl/error.hpp"
#include "krepl/owners.hpp"

namespace krepl::voronoi {

/// Area and length of a ring; arcs have this radius.
void measure(OwnerZone::Ring& ring, double radius);

/// Gives each hole to the smallest outer ring around it, and moves everything by `origin`. Rings of one owner touch in
/// points at most. ErrorCode::computation if a hole lies in nothing.
Status nest_rings(std::vector<OwnerZone::Ring> rings, Point origin, std::vector<OwnerZone::Polygon>& polygons);

}  // namespace krepl::voronoi
