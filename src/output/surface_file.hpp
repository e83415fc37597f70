#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/surface.hpp"

namespace krepl::output {

/// How the surface of terrain (+) ball goes into a file; docs/formats.md describes each.
struct SurfaceFormat {
  enum class Kind { json, gpkg, tif, stl, ply, glb, png, step };
  Kind kind = Kind::json;
  std::string name;  ///< as users write it

  bool is_text() const { return kind == Kind::json; }
  /// False for rasters of heights alone: they need no subdivision, see write_heights().
  bool needs_subdivision() const { return kind != Kind::tif; }
  bool is_mesh() const { return kind == Kind::stl || kind == Kind::ply || kind == Kind::glb; }
};

/// The format for a path, or the one asked for by its name. `-` without a name is JSON. Errors are of code usage and list what
/// there is.
Result<SurfaceFormat> find_surface_format(const std::string& path, const std::string& asked);

struct SurfaceFileOptions {
  std::string crs;       ///< WKT of the coordinate system; empty: none
  int curve_points = 5;  ///< JSON: points of an edge, 3 or more, ends included
  double max_error = 0;  ///< meshes, GeoPackage: largest deviation; 0: a thousandth of the radius
  double cell = 0;       ///< GeoTIFF: cell size; 0: that of the input raster, or a thousandth of the longer extent
  int width = 1600;      ///< PNG: columns
  bool solid = false;    ///< STEP: closed by walls and a floor
  std::string unit;      ///< STEP: unit of the coordinates; empty: that of the coordinate system, else mm
};

struct SurfaceFileReport {
  /// Meshes and GeoPackage: a bound of the largest distance between what was written and the true surface. STEP: the
  /// largest distance found between an edge and the surfaces that it bounds.
  std::optional<double> deviation;
  std::size_t triangles = 0;           ///< meshes
  std::string faces;                   ///< STEP: how many of each kind, in words
  std::size_t columns = 0, rows = 0;   ///< rasters
  std::size_t cells_without_data = 0;  ///< rasters: places where the ball touches nothing
  std::vector<std::string> notes;
};

/// What kinds are called in files.
const char* name_of(Surface::EdgeKind kind);
const char* name_of(Surface::Curve curve);
const char* name_of(Terrain::FeatureKind kind);

/// What to say before a file is written that is larger than its readers like; nothing if it is not.
std::optional<std::string> size_warning(const Surface& surface, const SurfaceFormat& format);

/// Writes a surface. The file appears whole or not at all. Errors: whatever keeps the file from being written; an option
/// out of its range (usage); cancelled.
Result<SurfaceFileReport> write_surface(const std::string& path, const Surface& surface, const SurfaceFormat& format,
                                        const SurfaceFileOptions& options, const Context& context = {});

/// Writes the heights of terrain (+) ball on a grid (format tif), straight from the terrain.
Result<SurfaceFileReport> write_heights(const std::string& path, std::shared_ptr<const Terrain> terrain, double radius,
                                        const SurfaceFileOptions& options, const Context& context = {});

}  // namespace krepl::output
