#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "krepl/section.hpp"
#include "output/zone_file.hpp"

namespace krepl::output {

/// How contours and sections go into a file; docs/formats.md describes each.
struct CutFormat {
  bool csv = false;   ///< pieces as rows, exactly
  ZoneFormat vector;  ///< if not csv
  const std::string& name() const { return vector.name; }
};

/// The format for a path, or the one asked for: csv, gpkg, fgb, wkt, geojson, shp, svg, dxf or the name of a GDAL
/// vector driver. `-` without a name is CSV. Errors are of code usage.
Result<CutFormat> find_cut_format(const std::string& path, const std::string& asked);

struct CutFileOptions {
  std::string crs;       ///< WKT of the coordinate system; empty: none
  double max_error = 0;  ///< where a format has no true curve: largest deviation; positive
};

struct CutFileReport {
  bool has_chords = false;  ///< some curve was replaced by chords within max_error
  std::vector<std::string> notes;
};

/// Writes contours of one terrain, a line a ring, or sections, a line a chain. In the plane of a drawing (svg, dxf) a
/// section has the distance along its line to the right and z upwards. The file appears whole or not at all. Errors:
/// whatever keeps the file from being written; wkb (usage); cancelled.
Result<CutFileReport> write_contours(const std::string& path, std::span<const Contour> contours, const Terrain& terrain,
                                     const CutFormat& format, const CutFileOptions& options,
                                     const Context& context = {});
Result<CutFileReport> write_sections(const std::string& path, std::span<const Section> sections, const Terrain& terrain,
                                     const CutFormat& format, const CutFileOptions& options,
                                     const Context& context = {});

}  // namespace krepl::output
