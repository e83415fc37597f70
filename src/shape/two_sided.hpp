#pragma once

#include <memory>
#include <utility>

#include "krepl/context.hpp"
#include "krepl/shape.hpp"
#include "krepl/zone.hpp"
#include "shape/check_options.hpp"
#include "zone/assembly.hpp"
#include "zone/shaped_rings.hpp"

namespace krepl::shape {

/// Rings of the zone of all sides, segments and points, and how far apart they are at least.
struct Outline {
  zone::ShapedRings rings;
  double slack = 0;
  ZoneCounters counters;
};

/// A zone on both sides, a shrunken polygon, or a ring. `Lines` says what lines are made of, segments or also arcs: Lines::Network, and
///   straight(network), the network of their vertices,
///   border_network, union_border (shape/polygon_border.hpp),
///   outline(network, options, context), of the absolute value of the distance,
///   rings_by_polygons (zone/nesting.hpp).
template <class Lines>
Result<Zone> two_sided(std::shared_ptr<const typename Lines::Network> network, const ShapeOptions& o,
                       const Context& context) {
  std::shared_ptr<const typename Lines::Network> base = network;
  const bool inward = o.distance < 0;
  if (inward) {
    if (Status shrinkable = check_shrinkable(Lines::straight(*network)); !shrinkable) return shrinkable.error();
    auto border = Lines::border_network(network, context);
    if (!border) return border.error();
    if (*border == nullptr) return ZoneAssembly::finish(network, o.distance, {}, 0, {}, context);
    base = std::move(*border);
  }
  Result<Outline> found = Lines::outline(*base, o, context);
  if (!found) return found.error();
  zone::ShapedRings rings = std::move(found->rings);
  if (Lines::straight(*network).has_polygons())
    rings = Lines::rings_by_polygons(*network, rings, Lines::straight(*base).origin(), inward);
  if (o.ring) {
    auto border = Lines::union_border(*network, *base, context);
    if (!border) return border.error();
    // Outwards the zone is what lies between its rings and the border, inwards the same from the other side.
    rings.append(inward ? *border : zone::reversed(*border));
  } else if (inward) {
    rings = zone::reversed(rings);
  }
  return ZoneAssembly::finish(std::move(base), o.distance, std::move(rings), found->slack, found->counters, context);
}

}  // namespace krepl::shape
