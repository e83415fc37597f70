#include "output/surface_raster.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "output/surface_writers.hpp"

namespace krepl::output {

SurfaceFrame surface_frame(const Terrain& terrain, double radius) {
  const Point3 low = terrain.lowest(), high = terrain.highest();
  return {low.x - radius, low.y - radius, high.x + radius, high.y + radius};
}

Result<DropCutter::Raster> covering_raster(const SurfaceFrame& frame, double cell_x, double cell_y, const char* what) {
  const double columns = std::max(1.0, std::ceil(frame.width() / cell_x * (1 - 1e-12)));
  const double rows = std::max(1.0, std::ceil(frame.height() / cell_y * (1 - 1e-12)));
  constexpr double most_a_side = 0x7fffffff, most = 4e10;
  if (!(columns <= most_a_side && rows <= most_a_side && columns * rows <= most)) {
    return Error{ErrorCode::usage, fmt::format("{:.0f} x {:.0f} cells are too many", columns, rows), "",
                 std::string("change ") + what};
  }
  DropCutter::Raster raster;
  raster.step_x = cell_x;
  raster.step_y = -cell_y;
  raster.columns = static_cast<std::size_t>(columns);
  raster.rows = static_cast<std::size_t>(rows);
  // What the last cells cover too much lies on both sides alike.
  raster.first = {(frame.min_x + frame.max_x) / 2 - (columns - 1) / 2 * cell_x,
                  (frame.min_y + frame.max_y) / 2 + (rows - 1) / 2 * cell_y};
  return raster;
}

Status for_each_strip(const DropCutter& cutter, const DropCutter::Raster& raster, std::size_t rows_multiple,
                      const Context& context,
                      const std::function<Status(std::size_t, std::size_t, std::span<const DropCutter::Contact>)>& take) {
  constexpr std::size_t places_at_once = std::size_t{1} << 20;
  std::size_t rows_at_once = std::max<std::size_t>(1, places_at_once / raster.columns);
  rows_at_once = (rows_at_once + rows_multiple - 1) / rows_multiple * rows_multiple;
  std::vector<DropCutter::Contact> contacts;
  for (std::size_t row = 0; row < raster.rows; row += rows_at_once) {
    DropCutter::Raster strip = raster;
    strip.rows = std::min(rows_at_once, raster.rows - row);
    strip.first = raster.place(0, row);
    contacts.resize(strip.rows * strip.columns);
    Context part = context;
    if (context.progress) {
      part.progress = [&](double fraction) {
        context.progress((double(row) + fraction * double(strip.rows)) / double(raster.rows));
      };
    }
    if (Status rested = cutter.at(strip, contacts, part); !rested) {
      return rested.error().code == ErrorCode::cancelled ? surface_interrupted() : rested.error();
    }
    if (Status taken = take(row, strip.rows, contacts); !taken) return taken;
  }
  return std::monostate{};
}

}  // namespace krepl::output
