#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/terrain.hpp"

namespace krepl::input {

/// Of a mesh's own coordinates.
enum class Axis : std::uint8_t { x, y, z, minus_x, minus_y, minus_z };

struct TerrainRequest {
  std::string path;    ///< any GDAL raster; .stl .obj .ply .off; these compressed with gzip; `-` for a text format
  std::string crs;     ///< coordinate system of the data, in place of what the file says (or does not say)
  std::string to_crs;  ///< rasters: plane coordinate system to resample to; `auto` chooses one around the data
  Axis up = Axis::z;   ///< meshes: which of their axes points upwards; they are turned until it is z, not mirrored
  double z_scale = 1;  ///< heights are multiplied by it; finite and not zero
  std::optional<Terrain::Split> split;  ///< rasters: diagonal of the cells; rising if not given
  int band = 0;                         ///< rasters: which band, from 1; 0: the first one, noted if there are more
};

struct TerrainFile {
  std::shared_ptr<const Terrain> terrain;
  std::string crs;                 ///< WKT 2 of the terrain's coordinates; empty: a plane of unknown place
  std::string crs_name;            ///< what people call it; empty likewise
  std::vector<std::string> notes;  ///< what the user should know: resampling, bands and vertices left out, and the like
};

/// Reads a terrain or part. The extension says whether it is a mesh; everything else is a raster. On standard input
/// (`-`) the text itself tells: OFF, PLY, STL and OBJ are recognised, anything else is left to GDAL.
///
/// Errors: no such file, a directory, an empty or truncated file, not a format that is read, options of rasters given
/// with a mesh or the other way round (usage), and all that read_raster, read_mesh and the constructors of Terrain report.
Result<TerrainFile> read_terrain(const TerrainRequest& request, const Context& context = {});

/// Extensions that read_terrain takes for meshes, without dot.
bool is_mesh_extension(const std::string& extension);

}  // namespace krepl::input
