#include "input/raster_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "input/raster_pixels.hpp"
#include "ogr/message_capture.hpp"

namespace krepl::input {

namespace {

/// Puts the pixels in the order of a Grid: rows from least y, x ascending.
RasterData to_grid(RasterPixels pixels) {
  const auto& t = pixels.transform;
  const std::size_t columns = pixels.columns, rows = pixels.rows;
  if (t[5] < 0) {  // north up: the file's first row has the largest y
    for (std::size_t low = 0, high = rows - 1; low < high; ++low, --high) {
      const auto first = pixels.heights.begin() + std::ptrdiff_t(low * columns);
      std::swap_ranges(first, first + std::ptrdiff_t(columns), pixels.heights.begin() + std::ptrdiff_t(high * columns));
    }
  }
  if (t[1] < 0) {
    for (std::size_t row = 0; row < rows; ++row) {
      const auto first = pixels.heights.begin() + std::ptrdiff_t(row * columns);
      std::reverse(first, first + std::ptrdiff_t(columns));
    }
  }
  RasterData data;
  data.grid.columns = columns, data.grid.rows = rows;
  data.grid.first = pixels.place(t[1] < 0 ? double(columns) - 0.5 : 0.5, t[5] < 0 ? double(rows) - 0.5 : 0.5);
  data.grid.cell_x = std::abs(t[1]), data.grid.cell_y = std::abs(t[5]);
  data.heights = std::move(pixels.heights);
  data.crs = std::move(pixels.crs);
  return data;
}

Status check_axes(const RasterPixels& pixels) {
  if (pixels.transform[2] == 0 && pixels.transform[4] == 0) return std::monostate{};
  return Error{ErrorCode::input, "the raster is rotated or sheared: its rows do not follow x", "",
               pixels.crs ? "resample it with --to-crs, or with gdalwarp" : "resample it with gdalwarp"};
}

/// Degrees that nobody declared: a plane of a few units under heights of hundreds.
void note_likely_degrees(const RasterData& data, std::vector<std::string>& notes) {
  if (data.crs) return;
  const double width = double(data.grid.columns) * data.grid.cell_x, height = double(data.grid.rows) * data.grid.cell_y;
  const Point low = data.grid.first;
  if (std::abs(low.x) > 360 || std::abs(low.y) > 90 || low.x + width > 361 || low.y + height > 91) return;
  if (data.grid.cell_x == 1 || data.grid.cell_y == 1 || std::max(data.grid.cell_x, data.grid.cell_y) > 0.1) return;
  double least = INFINITY, most = -INFINITY;
  for (const double h : data.heights)
    if (!std::isnan(h)) least = std::min(least, h), most = std::max(most, h);
  if (!(most - least > 10 * std::max(width, height))) return;
  notes.emplace_back(
      "note: no coordinate system is given and the coordinates look like degrees; if they are, name it with --crs and "
      "add --to-crs auto");
}

}  // namespace

Result<RasterData> read_raster(const std::string& vsi_path, const TerrainRequest& request, const Context& context) {
  auto dataset = open_raster(vsi_path);
  if (!dataset) return dataset.error();
  std::vector<std::string> notes;
  Result<RasterPixels> pixels = read_pixels(**dataset, request, notes, context);
  if (!pixels) return pixels.error();
  if (Status projected = project_pixels(*pixels, request.to_crs, notes, context); !projected) return projected.error();
  if (Status axes = check_axes(*pixels); !axes) return axes.error();
  RasterData data = to_grid(std::move(*pixels));
  note_likely_degrees(data, notes);
  data.notes = std::move(notes);
  return data;
}

}  // namespace krepl::input
