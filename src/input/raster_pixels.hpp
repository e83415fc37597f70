#pragma once

#include <gdal_priv.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "input/terrain_reader.hpp"
#include "krepl/context.hpp"
#include "krepl/error.hpp"

namespace krepl::input {

/// The pixels of a band as the file has them.
struct RasterPixels {
  std::size_t columns = 0, rows = 0;
  std::array<double, 6> transform{};  ///< GDAL's: from (column, row) of pixel corners to x, y
  std::vector<double> heights;        ///< row by row as in the file; NaN: no data
  std::optional<OGRSpatialReference> crs;

  Point place(double column, double row) const {
    return {transform[0] + column * transform[1] + row * transform[2],
            transform[3] + column * transform[4] + row * transform[5]};
  }
};

/// The first two steps of read_raster: opening the file, and reading the band that was asked for.
Result<std::unique_ptr<GDALDataset>> open_raster(const std::string& vsi_path);
Result<RasterPixels> read_pixels(GDALDataset& dataset, const TerrainRequest& request, std::vector<std::string>& notes,
                                 const Context& context);

/// An Error if there are more samples than Terrain takes.
Status check_size(const RasterPixels& pixels);

/// The third: resamples the pixels to `to_crs` if it is given; checks that the coordinates are in a plane.
Status project_pixels(RasterPixels& pixels, const std::string& to_crs, std::vector<std::string>& notes,
                      const Context& context);

}  // namespace krepl::input
