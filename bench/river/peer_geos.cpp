#include "peer_geos.hpp"

#include <geos_c.h>

#include "../zone/geos_lines.hpp"

namespace bench {

std::optional<Reaches> reaches_by_geos(const Lines& lines) {
  const GEOSContextHandle_t geos = GEOS_init_r();
  GEOSGeometry* const input = multi_line(geos, lines);
  std::size_t count = 0;
  const auto measured = measure(
      [&] {
        GEOSGeometry* const noded = GEOSNode_r(geos, input);
        GEOSGeometry* const merged = noded == nullptr ? nullptr : GEOSLineMerge_r(geos, noded);
        if (merged != nullptr) count = std::size_t(GEOSGetNumGeometries_r(geos, merged));
        const bool done = merged != nullptr;
        if (noded != nullptr) GEOSGeom_destroy_r(geos, noded);
        if (merged != nullptr) GEOSGeom_destroy_r(geos, merged);
        return done;
      },
      1);
  GEOSGeom_destroy_r(geos, input);
  GEOS_finish_r(geos);
  if (!measured) return std::nullopt;
  return Reaches{*measured, count};
}

}  // namespace bench
