#pragma once

#include <span>

#include "krepl/context.hpp"
#include "krepl/curve_network.hpp"
#include "krepl/error.hpp"
#include "krepl/shape.hpp"
#include "shape/two_sided.hpp"
#include "zone/shaped_rings.hpp"

namespace krepl::arcs {

/// Rings of the zone of all segments, arcs and points: of the distance's absolute value, and caps and joins.
Result<shape::Outline> outline(const CurveNetwork& network, const ShapeOptions& options, const Context& context);
/// The same with a radius for each part, round.
Result<shape::Outline> outline(const CurveNetwork& network, std::span<const double> part_radii, const Context& context);

/// The rings that lie inside a polygon of the network, or those that do not. They keep a distance of the radius from
/// its border, so any place of a ring decides. `origin` is that of the rings.
zone::ShapedRings rings_by_polygons(const CurveNetwork& network, const zone::ShapedRings& rings, Point origin,
                                    bool inside);

}  // namespace krepl::arcs
