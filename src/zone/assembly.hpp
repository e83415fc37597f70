#pragma once

#include <memory>

#include "krepl/zone.hpp"
#include "zone/nesting.hpp"
#include "zone/shaped_rings.hpp"

namespace krepl {

/// Builds a Zone, with its subdivision.
class ZoneAssembly {
 public:
  /// From closed rings, by whichever engine: contracts what no double lies between, drops what lies inside polygons,
  /// nests.
  static Result<Zone> finish(std::shared_ptr<const Network> network, const zone::Instance& instance, zone::Rings rings,
                             double resolution, ZoneCounters counters, const Context& context,
                             std::shared_ptr<const zone::VariedSites> varied = nullptr);

  /// From closed rings of any pieces, the zone on their left. `distance` is the radius, negative where polygons were
  /// shrunk; pieces that have no radius get it; opposite boundaries are no nearer to each other than `slack`.
  static Result<Zone> finish(std::shared_ptr<const Network> network, double distance, zone::ShapedRings rings,
                             double slack, const ZoneCounters& counters, const Context& context);
  /// The same of lines with arcs; `least`: the smallest radius, where there are several.
  static Result<Zone> finish(std::shared_ptr<const CurveNetwork> curves, double distance, zone::ShapedRings rings,
                             double slack, const ZoneCounters& counters, const Context& context, double least = 0);

  /// zone_band.
  static Result<Zone> band(const Zone& inner, const Zone& outer, const Context& context);

 private:
  static zone::ShapedRings shaped(const Zone& zone);
  /// From closed and nested rings.
  static Zone assemble(std::shared_ptr<const Network> network, double radius, zone::Rings rings,
                       const zone::Nesting& nesting, const ZoneCounters& counters, const Context& context);
  static void add_polygons(Zone& zone, const zone::Nesting& nesting);
  static void add_subdivision(Zone& zone, const zone::Nesting& nesting, const Context& context);
};

}  // namespace krepl
