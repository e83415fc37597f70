#pragma once

#include <ogr_spatialref.h>

#include <optional>
#include <string>
#include <vector>

#include "input/terrain_reader.hpp"
#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/terrain.hpp"

namespace krepl::input {

struct RasterData {
  Terrain::Grid grid;
  std::vector<double> heights;  ///< row by row from least y; NaN: no data
  std::optional<OGRSpatialReference> crs;
  std::vector<std::string> notes;
};

/// Reads one band of a raster: samples at the centres of pixels; no-data values, masked pixels and NaN become NaN. A
/// band's own scale and offset are applied (noted). Without georeference pixels are 1 x 1, the lower left corner of the
/// raster at (0, 0) (noted).
///
/// With `to_crs` the heights are resampled by bilinear interpolation to a north-up grid in that system, of the cell
/// size that GDAL finds fitting (noted).
///
/// `vsi_path` is a path of GDAL's virtual file systems. Errors: not a raster; no band, or no such one; several rasters
/// in one file (they are listed); complex numbers; an infinite height (named by column and row, from the upper left,
/// and by place); degrees, rows or columns that do not follow x and y, both without `to_crs`; a place that the
/// projection does not reach; more than 2^29 samples; a file that ends early; cancelled.
Result<RasterData> read_raster(const std::string& vsi_path, const TerrainRequest& request, const Context& context = {});

}  // namespace krepl::input
