#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/river.hpp"
#include "krepl/zone.hpp"
#include "output/kept_fields.hpp"
#include "output/zone_file.hpp"

namespace krepl::output {

struct RiverFileOptions {
  std::string crs;       ///< WKT of the coordinate system; empty: none
  bool reaches = false;  ///< reaches in place of sub-rivers; a GeoPackage has both anyway
  AttributeRows attributes = {};  ///< of the input: reaches and sub-rivers keep those of the feature they come from
  double max_error = 0;  ///< zones in formats without curves: largest deviation; 0: a thousandth of the radius
};

/// Writes sub-rivers with their attributes (docs/rivers.md lists them). GeoPackage: layers `sub_rivers`, `reaches` and
/// `nodes`; WKT and WKB: a line a sub-river, longest first; SVG: a drawing; any other format of find_zone_format
/// through its OGR driver, one layer. The file appears whole or not at all. Returns notes for the user.
Result<std::vector<std::string>> write_rivers(const std::string& path, const RiverNetwork& rivers,
                                              const ZoneFormat& format, const RiverFileOptions& options,
                                              const Context& context = {});

/// What a zone belongs to.
enum class RiverPart { sub_river, stem, whole };

/// Writes zones of parts of a river network, each a feature with the attributes of its part: zone i is that of
/// sub-river i, of the i-th main stem with all that comes to it, or of everything. Formats that hold no attributes get
/// the zones alone.
Result<ZoneFileReport> write_river_zones(const std::string& path, const RiverNetwork& rivers, RiverPart part,
                                         std::span<const Zone> zones, const ZoneFormat& format,
                                         const RiverFileOptions& options, const Context& context = {});

}  // namespace krepl::output
