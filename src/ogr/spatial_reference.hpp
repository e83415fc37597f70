#pragma once

#include <ogr_spatialref.h>

#include <string>

#include "krepl/error.hpp"

namespace krepl::ogr {

/// A coordinate system from what users write (`EPSG:25832`, `OGC:CRS84`, WKT, PROJJSON, a PROJ string, a file). Axes are
/// x then y (longitude then latitude), as in the coordinates krepl works with.
Result<OGRSpatialReference> parse_crs(const std::string& text);

/// The name people know it by, with its code where it has one: `WGS 84 / UTM zone 32N (EPSG:32632)`.
std::string crs_name(const OGRSpatialReference& crs);

/// The complete definition as WKT 2, the form in which krepl carries coordinate systems from input to output.
std::string crs_definition(const OGRSpatialReference& crs);

}  // namespace krepl::ogr
