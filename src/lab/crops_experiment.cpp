// Section 4.3's bound is far from what real ground has: vertices against triangles over parts of an elevation model.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "lab/chart.hpp"
#include "lab/count_columns.hpp"
#include "lab/experiments.hpp"
#include "lab/fit.hpp"
#include "model/terrain_access.hpp"

namespace krepl::lab {

namespace {

constexpr std::size_t fewest_samples = 16;  // along the shorter side of a part

/// Columns and rows about the middle of a grid. Nothing if no triangle is left there.
std::shared_ptr<const Terrain> part_of(const Terrain& whole, std::size_t columns, std::size_t rows) {
  const TerrainAccess access(whole);
  const std::size_t first_column = (whole.grid().columns - columns) / 2, first_row = (whole.grid().rows - rows) / 2;
  std::vector<double> heights;
  heights.reserve(columns * rows);
  for (std::size_t j = 0; j < rows; ++j) {
    const auto row = access.heights().begin() + std::ptrdiff_t((first_row + j) * whole.grid().columns + first_column);
    heights.insert(heights.end(), row, row + std::ptrdiff_t(columns));
  }
  Terrain::Grid grid = whole.grid();
  grid.columns = columns, grid.rows = rows;
  grid.first = {access.grid_x(first_column), access.grid_y(first_row)};
  auto part = Terrain::from_grid(grid, std::move(heights));
  return part ? std::make_shared<const Terrain>(std::move(*part)) : nullptr;
}

/// The whole and its parts, the smallest first.
std::vector<std::shared_ptr<const Terrain>> parts_of(const Terrain& whole) {
  std::vector<std::shared_ptr<const Terrain>> parts;
  std::size_t columns = whole.grid().columns, rows = whole.grid().rows;
  do {
    if (auto part = part_of(whole, columns, rows)) parts.push_back(std::move(part));
    columns /= 2, rows /= 2;
  } while (std::min(columns, rows) >= fewest_samples);
  std::reverse(parts.begin(), parts.end());
  return parts;
}

}  // namespace

Result<Report> crops_experiment(const Terrain& terrain, const std::vector<double>& radii, const Context& context) {
  if (!terrain.is_grid())
    return Error{ErrorCode::input, "parts are cut from rasters only, this is a mesh", "", "give an elevation model"};
  Report report;
  report.name = "real";
  report.table.columns = {"radius", "columns", "rows", "triangles"};
  append_count_names(report.table);
  report.table.columns.push_back("vertices/triangle");
  Chart chart{"Parts of an elevation model", "triangles", "vertices of the boundary", {}};
  const auto parts = parts_of(terrain);
  for (const double radius : radii) {
    std::vector<Point> points;
    for (const auto& part : parts) {
      const auto surface = compute_surface(part, {radius}, context);
      if (!surface) return surface.error();
      const terrain::SurfaceCounts counts = terrain::count_surface(*surface);
      const std::size_t triangles = part->triangle_count();
      std::vector<Table::Value> row{radius, whole(part->grid().columns), whole(part->grid().rows), whole(triangles)};
      append_counts(row, counts);
      row.emplace_back(double(counts.vertices) / double(triangles));
      report.table.rows.push_back(std::move(row));
      points.push_back({double(triangles), double(counts.vertices)});
    }
    chart.series.push_back({fmt::format("R = {}", radius), points, true, false});
    if (points.size() < 2) continue;
    const double exponent = fitted_exponent(points);
    report.results.emplace_back(fmt::format("radius {}: exponent", radius), exponent);
    report.findings.push_back(fmt::format("radius {}: vertices grow as triangles^{:.3f}", radius, exponent));
  }
  report.exhibits.push_back({"real.svg", svg_of(chart)});
  return report;
}

}  // namespace krepl::lab
