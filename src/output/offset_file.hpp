#pragma once

#include <span>
#include <string>
#include <vector>

#include "krepl/offset.hpp"
#include "output/zone_file.hpp"

namespace krepl::output {

/// Curves at one distance.
struct OffsetSet {
  double distance;
  std::vector<OffsetCurve> curves;
};

struct OffsetFileOptions {
  std::string crs;       ///< WKT of the coordinate system; empty: none
  double max_error = 0;  ///< formats without curves: largest deviation; 0: a thousandth of the distance
};

/// Writes parallel curves, each a feature with `distance`, `length`, `closed`, `feature` and `part`, in the order
/// given. True arcs in GeoPackage, FlatGeobuf, WKT, WKB (curve geometries), DXF (bulges, on layers OFFSET_<distance>)
/// and SVG (with `network`, the input, below them); chords elsewhere. The file appears whole or not at all.
Result<ZoneFileReport> write_offsets(const std::string& path, std::span<const OffsetSet> sets, const Network& network,
                                     const ZoneFormat& format, const OffsetFileOptions& options,
                                     const Context& context = {});

}  // namespace krepl::output
