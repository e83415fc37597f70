#pragma once

#include <geos_c.h>

#include <vector>

#include "lines.hpp"

namespace bench {

/// All lines as one MultiLineString of GEOS, which the caller destroys.
inline GEOSGeometry* multi_line(GEOSContextHandle_t context, const Lines& lines) {
  std::vector<GEOSGeometry*> parts;
  for (std::size_t i = 0; i < lines.count(); ++i) {
    const std::size_t begin = lines.begin[i], end = lines.begin[i + 1];
    GEOSCoordSequence* sequence = GEOSCoordSeq_create_r(context, unsigned(end - begin), 2);
    for (std::size_t j = begin; j < end; ++j)
      GEOSCoordSeq_setXY_r(context, sequence, unsigned(j - begin), lines.points[j].x, lines.points[j].y);
    parts.push_back(GEOSGeom_createLineString_r(context, sequence));
  }
  return GEOSGeom_createCollection_r(context, GEOS_MULTILINESTRING, parts.data(), unsigned(parts.size()));
}

}  // namespace bench
