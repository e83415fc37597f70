#pragma once

#include <memory>

#include "arcs/bodies.hpp"
#include "krepl/context.hpp"
#include "krepl/curve_network.hpp"
#include "krepl/error.hpp"
#include "zone/shaped_rings.hpp"

namespace krepl::arcs {

/// The lines that zones inside polygons with arcs are made of: the border of each feature's inside by the even-odd rule.
/// The network itself where no sides run along each other, else without those that have the inside on both sides. Null
/// if no border is left. (Sides that cross need no cut: all of them are border.)
Result<std::shared_ptr<const CurveNetwork>> border_network(std::shared_ptr<const CurveNetwork> network,
                                                           const Context& context);

/// The border of the union of all polygons as rings with the inside on their left, relative to the origin of `target`;
/// sources are its segments and arcs.
Result<zone::ShapedRings> union_border(const CurveNetwork& network, const CurveNetwork& target, const Context& context);

}  // namespace krepl::arcs
