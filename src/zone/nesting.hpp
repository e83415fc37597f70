#pragma once

#include <vector>

#include "krepl/context.hpp"
#include "krepl/network.hpp"
#include "zone/rings.hpp"
#include "zone/shaped_rings.hpp"

namespace krepl::zone {

/// How rings lie in each other. For a hole: the outer ring of its component. For an outer ring: the hole it lies in, or
/// none if it borders the unbounded face.
struct Nesting {
  std::vector<bool> is_hole;
  std::vector<Index> parent;
};

/// By a ray from each ring's leftmost point to the next ring on its left. ErrorCode::computation if a hole lies in nothing.
/// O((rings + pieces) log pieces), expected.
Result<Nesting> nest(const Instance& instance, const Rings& rings, const Context& context);

/// The same for rings of any pieces, arcs of the given radius if they have none of their own. Opposite boundaries are `slack` apart at least.
Result<Nesting> nest(const ShapedRings& rings, double radius, double slack, const Context& context);

/// Drops the rings that lie inside a polygon of the network (even-odd rule per feature): their far side is filled. Each
/// ring keeps a distance of R from all input, so a single point of it decides.
Rings drop_rings_inside_polygons(const Network& network, Rings rings);

/// The rings that lie inside a polygon of the network, or those that do not. They keep away from its border, too. `origin`
/// is that of the rings.
ShapedRings rings_by_polygons(const Network& network, const ShapedRings& rings, Point origin, bool inside);

}  // namespace krepl::zone
