#pragma once

// The writers behind write_zones, one a format, and what they share.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/zone.hpp"
#include "output/linear.hpp"
#include "output/zone_curves.hpp"
#include "output/zone_file.hpp"

namespace krepl::output {

/// One feature of a file: some polygons of a zone.
struct ZoneFeature {
  std::uint32_t first_polygon = 0, polygon_count = 0;
  std::optional<double> radius;  ///< none where parts of the input have radii of their own
  double area = 0, perimeter = 0;
  std::uint64_t holes = 0;
  double inner_radius = 0;  ///< 0: a whole zone
};

/// What a zone becomes in a file: one feature, or one a polygon.
std::vector<ZoneFeature> zone_features(const Zone& zone, bool separate);

/// Deviation asked for, for a zone of this radius.
double max_error_for(const ZoneFileOptions& options, double radius);

inline Error interrupted_while_writing() { return {ErrorCode::cancelled, "interrupted while writing", "", ""}; }

using WriteResult = Result<ZoneFileReport>;
WriteResult write_wkt(const std::string& path, std::span<const Zone> zones, const ZoneFileOptions&, const Context&);
WriteResult write_wkb(const std::string& path, std::span<const Zone> zones, const ZoneFileOptions&, const Context&);
WriteResult write_geojson(const std::string& path, std::span<const Zone> zones, const ZoneFileOptions&, const Context&);
WriteResult write_svg(const std::string& path, std::span<const Zone> zones, const ZoneFileOptions&, const Context&);
WriteResult write_dxf(const std::string& path, std::span<const Zone> zones, const ZoneFileOptions&, const Context&);
WriteResult write_ogr(const std::string& path, const std::string& driver, std::span<const Zone> zones,
                      const ZoneFileOptions&, const Context&);

}  // namespace krepl::output
