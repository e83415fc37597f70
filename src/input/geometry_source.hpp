#pragma once

#include <ogrsf_frmts.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"

namespace krepl::input {

/// Which part of a vector file to read; empty means no choice was made.
struct SourceSelection {
  std::string layer;
  std::string where;  ///< OGR's SQL WHERE clause over the layer's fields
};

/// The geometries of a file one after the other, whatever it is: a layer of any OGR data source, a text file with one WKT
/// geometry a line, a file of concatenated WKB geometries.
class GeometrySource {
 public:
  struct Item {
    std::int64_t number = 0;                ///< feature id; for WKT the line, for WKB the running number from 1
    const OGRGeometry* geometry = nullptr;  ///< null where the feature has none; lives until the next call
    const OGRFeature* feature = nullptr;    ///< null for WKT and WKB; lives until the next call
  };

  virtual ~GeometrySource() = default;
  /// The next one, or nothing at the end.
  virtual Result<std::optional<Item>> next() = 0;
  /// The coordinate system of the file, where it is known; axes x, y. Complete once next() has returned nothing.
  virtual std::optional<OGRSpatialReference> crs() const = 0;
  /// What `number` counts: "feature" or "line".
  virtual const char* number_name() const = 0;
  /// The part read so far, in [0,1]; 0 where it is not known.
  virtual double fraction() const = 0;

  /// What the reader of this format loses, for the user to know.
  virtual std::vector<std::string> notes() const { return {}; }

  std::string place(std::int64_t number) const { return std::string(number_name()) + " " + std::to_string(number); }
};

/// Opens a file, a `.gz` or `.zip` of it, or `-` (WKT or GeoJSON text on standard input).
///
/// Errors name what to do: no such file, a directory, an empty file, not a format that OGR reads, unknown layer (lists
/// those there are), more than one layer and none chosen, a layer without geometry, an unknown field (lists those there are).
Result<std::unique_ptr<GeometrySource>> open_geometry_source(const std::string& path, const SourceSelection& selection,
                                                             const Context& context = {});

/// The parts of open_geometry_source, each for one kind of file; `vsi_path` is a path of GDAL's virtual file systems.
Result<std::unique_ptr<GeometrySource>> open_ogr_source(const std::string& vsi_path, const SourceSelection& selection);
Result<std::unique_ptr<GeometrySource>> open_wkt_source(const std::string& vsi_path);
Result<std::unique_ptr<GeometrySource>> open_wkb_source(const std::string& vsi_path);

/// Names of the layers that have geometry.
Result<std::vector<std::string>> geometry_layers(const std::string& path);

/// The path as GDAL's virtual file systems want it (`/vsigzip/...` for .gz, `/vsizip/...` for .zip), after checking that it
/// is there, is no directory and is not empty.
Result<std::string> checked_path(const std::string& path);

/// The extension in lower case without dot, after taking off .gz: "rivers.WKT.gz" -> "wkt".
std::string format_extension(const std::string& path);

}  // namespace krepl::input
