#include "simulate/part_heights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "kernel/parallel.hpp"
#include "model/terrain_access.hpp"

namespace krepl::simulate {
namespace {

/// Of weights, by which rounding may put a dexel on a side outside of both triangles.
constexpr double on_side = 1e-12;

class Canvas {
 public:
  Canvas(const Dexels& dexels, std::vector<double>& heights) : dexels_(dexels), heights_(heights) {}

  /// Rows first_row .. last_row - 1 only, so that bands can be drawn at the same time.
  void draw(const std::array<Point3, 3>& t, std::size_t first_row, std::size_t last_row) {
    const double ux = t[1].x - t[0].x, uy = t[1].y - t[0].y, vx = t[2].x - t[0].x, vy = t[2].y - t[0].y;
    const double area = ux * vy - uy * vx;
    if (area == 0) return;
    std::size_t c0, c1, r0, r1;
    if (!range(std::min({t[0].x, t[1].x, t[2].x}), std::max({t[0].x, t[1].x, t[2].x}), dexels_.first.x, dexels_.columns,
               c0, c1) ||
        !range(std::min({t[0].y, t[1].y, t[2].y}), std::max({t[0].y, t[1].y, t[2].y}), dexels_.first.y, dexels_.rows,
               r0, r1)) {
      return;
    }
    for (std::size_t row = std::max(r0, first_row); row <= r1 && row < last_row; ++row) {
      for (std::size_t column = c0; column <= c1; ++column) {
        const Point p = dexels_.place(column, row);
        const double ex = p.x - t[0].x, ey = p.y - t[0].y;
        const double v = (ex * vy - ey * vx) / area, w = (ux * ey - uy * ex) / area;
        if (v < -on_side || w < -on_side || v + w > 1 + on_side) continue;
        double& height = heights_[row * dexels_.columns + column];
        height = std::max(height, t[0].z + v * (t[1].z - t[0].z) + w * (t[2].z - t[0].z));
      }
    }
  }

 private:
  bool range(double low, double high, double first, std::size_t count, std::size_t& from, std::size_t& to) const {
    const double a = std::ceil((low - first) / dexels_.cell - 1e-6),
                 b = std::floor((high - first) / dexels_.cell + 1e-6);
    if (b < 0 || a > double(count - 1)) return false;
    from = std::size_t(std::max(a, 0.0)), to = std::size_t(std::min(b, double(count - 1)));
    return from <= to;
  }
  const Dexels& dexels_;
  std::vector<double>& heights_;
};

/// Both for dexels of rows first .. last - 1, which lie between low_y and high_y.
void draw_grid(const Terrain& part, std::size_t first, std::size_t last, double low_y, double high_y, Canvas& canvas) {
  const TerrainAccess access(part);
  const Terrain::Grid& grid = part.grid();
  const std::size_t columns = grid.columns;
  for (std::size_t row = 0; row + 1 < grid.rows; ++row) {
    if (access.grid_y(row + 1) < low_y || access.grid_y(row) > high_y) continue;
    for (std::size_t column = 0; column + 1 < columns; ++column) {
      const auto cell = access.cell(column, row);
      const auto at = [&](std::size_t c, std::size_t r) {
        return Point3{access.grid_x(c), access.grid_y(r), access.heights()[r * columns + c]};
      };
      const Point3 sw = at(column, row), se = at(column + 1, row), nw = at(column, row + 1),
                   ne = at(column + 1, row + 1);
      if (cell.lower) canvas.draw(cell.falling ? std::array{sw, se, nw} : std::array{sw, se, ne}, first, last);
      if (cell.upper) canvas.draw(cell.falling ? std::array{se, ne, nw} : std::array{sw, ne, nw}, first, last);
    }
  }
}

void draw_mesh(const Terrain& part, std::size_t first, std::size_t last, double low_y, double high_y, Canvas& canvas) {
  const TerrainAccess access(part);
  for (const auto& triangle : access.triangles()) {
    if (triangle.vertical) continue;
    const auto& v = triangle.vertex;
    const std::array<Point3, 3> t{access.vertices()[v[0]], access.vertices()[v[1]], access.vertices()[v[2]]};
    if (std::max({t[0].y, t[1].y, t[2].y}) < low_y || std::min({t[0].y, t[1].y, t[2].y}) > high_y) continue;
    canvas.draw(t, first, last);
  }
}

}  // namespace

std::vector<double> part_heights(const Terrain& part, const Dexels& dexels, const Context& context) {
  std::vector<double> heights(dexels.columns * dexels.rows, -std::numeric_limits<double>::infinity());
  const std::size_t band = std::max<std::size_t>(1, (dexels.rows + 15) / 16);
  Context quiet;
  quiet.threads = context.threads, quiet.cancel = context.cancel;
  kernel::parallel_blocks(quiet, dexels.rows, band, [&](std::size_t first, std::size_t last) {
    Canvas canvas(dexels, heights);
    const double low_y = dexels.place(0, first).y - dexels.cell, high_y = dexels.place(0, last).y;
    if (part.is_grid())
      draw_grid(part, first, last, low_y, high_y, canvas);
    else
      draw_mesh(part, first, last, low_y, high_y, canvas);
  });
  return heights;
}

}  // namespace krepl::simulate
