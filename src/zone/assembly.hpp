#pragma once

#include <memory>

#include "krepl/zone.hpp"
#include "zone/nesting.hpp"

namespace krepl {

/// Builds a Zone, with its subdivision, from closed and nested rings.
class ZoneAssembly {
 public:
  static Zone assemble(std::shared_ptr<const Network> network, double radius, zone::Rings rings,
                       const zone::Nesting& nesting, const ZoneCounters& counters, const Context& context);

 private:
  static void add_polygons(Zone& zone, const zone::Nesting& nesting);
  static void add_subdivision(Zone& zone, const zone::Nesting& nesting, const Context& context);
};

}  // namespace krepl
