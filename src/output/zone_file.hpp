#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/zone.hpp"

namespace krepl::output {

/// How a zone goes into a file; docs/formats.md describes each.
struct ZoneFormat {
  enum class Kind { wkt, wkb, geojson, svg, dxf, ogr };
  Kind kind = Kind::wkt;
  std::string name;    ///< as users write it: gpkg, wkt, ... or the name of a GDAL driver
  std::string driver;  ///< kind ogr: the GDAL driver
  /// True for what can go to standard output.
  bool is_text() const { return kind != Kind::ogr && kind != Kind::wkb; }
};

/// The format for a path, or the one asked for: a name (gpkg, fgb, wkt, wkb, geojson, svg, dxf, shp), an extension or the
/// name of a GDAL vector driver. `-` without a name is WKT. Errors are of code usage and list what there is.
Result<ZoneFormat> find_zone_format(const std::string& path, const std::string& asked);

struct ZoneFileOptions {
  std::string crs;       ///< WKT of the coordinate system; empty: none
  double max_error = 0;  ///< formats without curves: largest deviation; 0: a thousandth of the radius
  bool pieces = true;    ///< GeoPackage: a second layer with one curve per boundary piece and where it comes from
  bool separate = false; ///< one feature (WKT: line) per polygon, not per radius
  bool bands = false;    ///< the zones are bands (zone_band): features tell their inner radius too
};

struct ZoneFileReport {
  /// Formats without curves: the largest distance between a chord and its arc. Nothing where the curves are true.
  std::optional<double> deviation;
  std::vector<std::string> notes;
};

/// Writes zones (of one network, usually at several radii), each as one feature, in the order given. The file appears whole
/// or not at all. Errors: whatever keeps the file from being written; cancelled.
Result<ZoneFileReport> write_zones(const std::string& path, std::span<const Zone> zones, const ZoneFormat& format,
                                   const ZoneFileOptions& options, const Context& context = {});

}  // namespace krepl::output
