// Terrains from grids. Only heights are stored; everything else follows from the place of a sample.
//
// Numbers of features: 6 * sample + k, samples row by row, and k =
//   0  the sample as a vertex
//   1  the edge to its neighbour in +x
//   2  the edge to its neighbour in +y
//   3  the diagonal of the cell of which it is the corner with least x and y
//   4  the triangle of that cell below the diagonal
//   5  the triangle above it
// What is cut away by missing samples has a number that is not in use.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "kernel/parallel.hpp"
#include "krepl/terrain.hpp"
#include "model/exact_origin.hpp"

namespace krepl {
namespace {

constexpr std::size_t most_samples = std::size_t{1} << 29;  // six features each must fit into 32 bits
constexpr std::size_t block_samples = std::size_t{1} << 16;
constexpr double infinity = std::numeric_limits<double>::infinity();

std::size_t rows_per_block(std::size_t columns) { return std::max<std::size_t>(1, block_samples / columns); }

Error cancelled() { return {ErrorCode::cancelled, "cancelled", "", ""}; }

/// Neighbouring samples must be apart by more than rounding in every place, as given too, or results could not be told
/// apart.
bool cells_are_distinct(double first, double last, double cell) {
  const double largest = std::max(std::abs(first), std::abs(last));
  return cell >= 8 * (std::nextafter(largest, infinity) - largest);
}

Status check_shape(const Terrain::Grid& grid, std::size_t heights) {
  if (grid.columns < 2 || grid.rows < 2) {
    return Error{ErrorCode::input, "a grid needs 2 x 2 samples or more",
                 std::to_string(grid.columns) + " x " + std::to_string(grid.rows), ""};
  }
  if (grid.columns > most_samples / grid.rows)
    return Error{ErrorCode::input, "there are more than 2^29 samples in the grid", "", "split the input"};
  if (heights != grid.columns * grid.rows) {
    return Error{ErrorCode::usage, "the number of heights is not columns times rows", std::to_string(heights), ""};
  }
  const double last_x = grid.first.x + double(grid.columns - 1) * grid.cell_x;
  const double last_y = grid.first.y + double(grid.rows - 1) * grid.cell_y;
  if (!std::isfinite(grid.first.x) || !std::isfinite(grid.first.y) || !std::isfinite(last_x) ||
      !std::isfinite(last_y)) {
    return Error{ErrorCode::input, "the place of the grid is NaN or infinite", "",
                 "correct its first sample or cell size"};
  }
  if (!(grid.cell_x > 0) || !(grid.cell_y > 0))
    return Error{ErrorCode::input, "the cell size of the grid is not positive", "", "correct it"};
  if (!cells_are_distinct(grid.first.x, last_x, grid.cell_x) ||
      !cells_are_distinct(grid.first.y, last_y, grid.cell_y)) {
    return Error{ErrorCode::input, "the cells of the grid are too small for coordinates of that size", "",
                 "shift or scale the grid"};
  }
  return std::monostate{};
}

struct Heights {
  double low = infinity, high = -infinity;
  std::size_t missing = 0, infinite = std::numeric_limits<std::size_t>::max();  // the first one
  void join(const Heights& other) {
    low = std::min(low, other.low), high = std::max(high, other.high);
    missing += other.missing, infinite = std::min(infinite, other.infinite);
  }
};

Heights survey(const std::vector<double>& heights, std::size_t first, std::size_t last) {
  Heights h;
  for (std::size_t i = first; i < last; ++i) {
    if (std::isnan(heights[i])) {
      ++h.missing;
    } else if (std::isinf(heights[i])) {
      h.infinite = std::min(h.infinite, i);
    } else {
      h.low = std::min(h.low, heights[i]), h.high = std::max(h.high, heights[i]);
    }
  }
  return h;
}

Context without_progress(const Context& context) {
  Context quiet;
  quiet.threads = context.threads;
  quiet.cancel = context.cancel;
  return quiet;
}

}  // namespace

Result<Terrain> Terrain::from_grid(const Grid& grid, std::vector<double> heights, const Context& context) {
  if (Status shape = check_shape(grid, heights.size()); !shape) return shape.error();
  const Context quiet = without_progress(context);
  const std::size_t count = heights.size();
  std::vector<Heights> parts(count / block_samples + 1);
  if (!kernel::parallel_blocks(quiet, count, block_samples, [&](std::size_t first, std::size_t last) {
        parts[first / block_samples] = survey(heights, first, last);
      })) {
    return cancelled();
  }
  Heights all;
  for (const Heights& part : parts) all.join(part);
  if (all.infinite < count) {
    return Error{ErrorCode::input, "a height is infinite",
                 "column " + std::to_string(all.infinite % grid.columns) + ", row " +
                     std::to_string(all.infinite / grid.columns),
                 "correct it or mark it as missing"};
  }
  if (all.missing == count) return Error{ErrorCode::input, "all samples of the grid are without data", "", ""};
  if (!std::isfinite(2 * (all.high - all.low)))
    return Error{ErrorCode::input, "the heights are too large for double precision", "", "scale them down"};

  Terrain t;
  t.is_grid_ = true;
  t.grid_ = grid;
  t.report_.missing_samples = all.missing;
  t.origin_ = {exact_origin(grid.first.x, grid.first.x + double(grid.columns - 1) * grid.cell_x),
               exact_origin(grid.first.y, grid.first.y + double(grid.rows - 1) * grid.cell_y),
               exact_origin(all.low, all.high)};
  t.grid_.first = {grid.first.x - t.origin_.x, grid.first.y - t.origin_.y};
  t.height_ = std::move(heights);
  if (t.origin_.z != 0 &&
      !kernel::parallel_blocks(quiet, count, block_samples, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) t.height_[i] -= t.origin_.z;
      })) {
    return cancelled();
  }
  if (Status surveyed = t.survey_grid(quiet); !surveyed) return surveyed.error();
  return t;
}

Terrain::Cell Terrain::cell(std::size_t column, std::size_t row) const {
  const std::size_t s = row * grid_.columns + column;
  const double h00 = height_[s], h10 = height_[s + 1], h01 = height_[s + grid_.columns],
               h11 = height_[s + grid_.columns + 1];
  const bool has00 = !std::isnan(h00), has10 = !std::isnan(h10), has01 = !std::isnan(h01), has11 = !std::isnan(h11);
  bool falling = grid_.split == Split::falling;
  if (grid_.split == Split::shorter) {
    falling = has10 && has01 && (!has00 || !has11 || std::abs(h10 - h01) < std::abs(h00 - h11));
  }
  if (falling) return {true, has10 && has01 && has00, has10 && has01 && has11};
  return {false, has00 && has11 && has10, has00 && has11 && has01};
}

/// Counts the triangles and takes their bounding box: samples that no triangle uses do not count.
Status Terrain::survey_grid(const Context& context) {
  struct Part {
    std::size_t triangles = 0;
    Point3 low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
  };
  const std::size_t block = rows_per_block(grid_.columns), cells = grid_.rows - 1;
  std::vector<Part> parts(cells / block + 1);
  const bool done = kernel::parallel_blocks(context, cells, block, [&](std::size_t first, std::size_t last) {
    Part part;
    for (std::size_t row = first; row < last; ++row) {
      for (std::size_t column = 0; column + 1 < grid_.columns; ++column) {
        const Cell c = cell(column, row);
        const int triangles = c.lower + c.upper;
        if (triangles == 0) continue;
        part.triangles += std::size_t(triangles);
        part.low.x = std::min(part.low.x, grid_x(column)), part.high.x = std::max(part.high.x, grid_x(column + 1));
        part.low.y = std::min(part.low.y, grid_y(row)), part.high.y = std::max(part.high.y, grid_y(row + 1));
        const std::size_t s = row * grid_.columns + column;
        for (const std::size_t corner : {s, s + 1, s + grid_.columns, s + grid_.columns + 1}) {
          // A cell with a triangle lacks one sample at most, so the ones it has are all in use.
          if (std::isnan(height_[corner])) continue;
          part.low.z = std::min(part.low.z, height_[corner]), part.high.z = std::max(part.high.z, height_[corner]);
        }
      }
    }
    parts[first / block] = part;
  });
  if (!done) return cancelled();
  Part all;
  for (const Part& part : parts) {
    all.triangles += part.triangles;
    all.low = {std::min(all.low.x, part.low.x), std::min(all.low.y, part.low.y), std::min(all.low.z, part.low.z)};
    all.high = {std::max(all.high.x, part.high.x), std::max(all.high.y, part.high.y),
                std::max(all.high.z, part.high.z)};
  }
  if (all.triangles == 0) {
    return Error{ErrorCode::input, "no triangle is left: no three neighbouring samples of a cell have data", "", ""};
  }
  triangle_count_ = report_.triangles = all.triangles;
  lowest_ = all.low, highest_ = all.high;
  return std::monostate{};
}

Terrain::Corners Terrain::grid_corners(Index feature) const {
  const std::size_t s = feature / 6, east = s + 1, north = s + grid_.columns, far = north + 1;
  const unsigned k = feature % 6;
  const auto points = [&](std::initializer_list<std::size_t> samples) {
    Corners c{};
    for (const std::size_t sample : samples) c.point[std::size_t(c.count++)] = grid_point(sample);
    return c;
  };
  if (k == 0) return points({s});
  if (k == 1) return points({s, east});
  if (k == 2) return points({s, north});
  const bool falling = cell(s % grid_.columns, s / grid_.columns).falling;
  if (k == 3) return falling ? points({east, north}) : points({s, far});
  if (k == 4) return falling ? points({s, east, north}) : points({s, east, far});
  return falling ? points({east, far, north}) : points({s, far, north});
}

}  // namespace krepl
