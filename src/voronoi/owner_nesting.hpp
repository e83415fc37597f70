#pragma once

#include <vector>

#include "krepl/error.hpp"
#include "krepl/owners.hpp"

namespace krepl::voronoi {

/// Cuts a closed chain of curves where it comes back to a place it has been at, so that rings touch themselves nowhere:
/// what is one ring that pinches itself off becomes an outer ring and holes that touch it.
std::vector<OwnerZone::Ring> split_at_pinches(std::vector<OwnerZone::Curve> curves);

/// Area and length of a ring; arcs have this radius.
void measure(OwnerZone::Ring& ring, double radius);

/// Gives each hole to the smallest outer ring around it, and moves everything by `origin`. Rings of one owner touch in
/// points at most. ErrorCode::computation if a hole lies in nothing.
Status nest_rings(std::vector<OwnerZone::Ring> rings, Point origin, std::vector<OwnerZone::Polygon>& polygons);

}  // namespace krepl::voronoi
