#pragma once

#include <ogr_feature.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "output/ogr_geometry.hpp"
#include "output/zone_file.hpp"

namespace krepl::output {

/// One feature of a file of features: the attributes it keeps, and what krepl adds.
struct ZoneRow {
  const OGRFeature* attributes = nullptr;  ///< of the input; null for none
  std::unique_ptr<OGRGeometry> geometry;
  std::vector<double> values;              ///< one for each of FeatureColumns::added
  double deviation = 0;                    ///< of chords from the truth
};

/// The fields of a file of features. A field of the input keeps its name and type where the format knows the type, else
/// it becomes text (noted); an added one whose name is taken is called zone_NAME.
struct FeatureColumns {
  const OGRFeatureDefn* kept = nullptr;  ///< null for none
  std::vector<std::string> only;         ///< of these, the ones to keep; empty: all
  struct Added {
    const char* name;
    OGRFieldType type;
  };
  std::vector<Added> added;
};

/// How the file wants its geometries.
struct GeometryStyle {
  bool curves = false;
  OuterSense sense = OuterSense::counter_clockwise;
};

/// Gives the next feature, or nothing at the end.
using NextRow = std::function<Result<std::optional<ZoneRow>>(const GeometryStyle& style)>;

/// Whether write_features knows the format: OGR's, GeoJSON, WKT and WKB; the last two hold no attributes.
bool holds_features(const ZoneFormat& format);

/// Writes features as they come, in their order; the file appears whole or not at all. Errors: those of `next`, and
/// whatever keeps the file from being written.
Result<ZoneFileReport> write_features(const std::string& path, const ZoneFormat& format, const std::string& crs,
                                      const FeatureColumns& columns, const NextRow& next);

}  // namespace krepl::output
