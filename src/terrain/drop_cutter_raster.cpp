// Rasters, tile by tile. Where places are close to each other, a few of them share one walk through the hierarchy.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "kernel/parallel.hpp"
#include "terrain/drop_cutter_hierarchy.hpp"
#include "terrain/drop_cutter_part.hpp"

namespace krepl {
namespace {

constexpr std::size_t tile_side = 32;  // places; the work of one block
constexpr std::size_t most_side = 8;   // places that share a walk
constexpr std::size_t least_together = 3;
constexpr double steepest_shared = 4;  // slopes of what other tools than balls rest on

/// Places [column, column + columns) x [row, row + rows) of a raster.
struct Patch {
  std::size_t column, row, columns, rows;
};

/// How many places to take together so that their list of parts stays short: where the ball moves by delta, the gap below
/// it changes by delta^2 / 2R, which should be a fraction of what the terrain rises and falls within a cell. The factors were
/// found by trial; in a mesh a walk costs more, so that it is worth sharing by longer lists.
std::size_t together(double step, double radius, double cell, bool is_grid) {
  const double reach = 2 * (is_grid ? 0.09 : 0.13) * std::sqrt(radius * cell);
  return step == 0 ? most_side : std::size_t(std::min(double(most_side), 1 + reach / std::abs(step)));
}

}  // namespace

/// The work on one tile of a raster.
template <class Tree, class Tool>
class DropCutter::TileWork {
 public:
  TileWork(const Hierarchy& hierarchy, const Tree& tree, const Tool& tool, const Raster& raster,
           std::span<Contact> contacts)
      : h_(hierarchy), tree_(tree), tool_(tool), raster_(raster), radius_(tool.radius), contacts_(contacts) {}

  /// Patches in a serpentine, so that each is next to the one before.
  void run(const Patch& tile, std::size_t side_x, std::size_t side_y) {
    const std::size_t across = (tile.columns + side_x - 1) / side_x, up = (tile.rows + side_y - 1) / side_y;
    for (std::size_t k = 0; k < across * up; ++k) {
      const std::size_t j = k / across, i = j % 2 == 0 ? k % across : across - 1 - k % across;
      const std::size_t column = i * side_x, row = j * side_y;
      run({tile.column + column, tile.row + row, std::min(side_x, tile.columns - column), std::min(side_y, tile.rows - row)});
    }
  }

 private:
  template <class Visit>
  void for_each(const Patch& patch, const Visit& visit) const {
    for (std::size_t k = 0; k < patch.columns * patch.rows; ++k) {
      const std::size_t j = k / patch.columns, i = j % 2 == 0 ? k % patch.columns : patch.columns - 1 - k % patch.columns;
      const std::size_t column = patch.column + i, row = patch.row + j;
      visit(raster_.place(column, row), contacts_[row * raster_.columns + column]);
    }
  }

  /// Together, or else in parts.
  void run(const Patch& patch) {
    if (patch.columns * patch.rows < least_together || trace_.triangle == Terrain::none)
      return run_one_by_one(patch);
    if (run_together(patch)) return;
    Patch first = patch, second = patch;
    if (patch.columns > patch.rows) {
      first.columns = patch.columns / 2, second.columns -= first.columns, second.column += first.columns;
    } else {
      first.rows = patch.rows / 2, second.rows -= first.rows, second.row += first.rows;
    }
    run(first);
    run(second);
  }

  void run_one_by_one(const Patch& patch) {
    for_each(patch,
             [&](Point place, Contact& contact) { contact = h_.touch(tree_, Hierarchy::over(place, tool_), trace_); });
  }

  /// False if the list would become long.
  bool run_together(const Patch& patch) {
    const Point a = raster_.place(patch.column, patch.row);
    const Point b = raster_.place(patch.column + patch.columns - 1, patch.row + patch.rows - 1);
    const Point centre{a.x / 2 + b.x / 2, a.y / 2 + b.y / 2};
    if (!std::isfinite(centre.x) || !std::isfinite(centre.y)) return false;
    // Half sides, with room for the rounding of places.
    const double half_x = std::abs(b.x - centre.x) + 0x1p-50 * (std::abs(a.x) + std::abs(b.x));
    const double half_y = std::abs(b.y - centre.y) + 0x1p-50 * (std::abs(a.y) + std::abs(b.y));
    drop::Shortlist list;
    Point slope;
    if (!survey(centre, half_x, half_y, slope, list)) return false;
    const double unit = tree_.inverse_unit();
    for_each(patch, [&](Point place, Contact& contact) {
      drop::ToolSearch<Tool> search = h_.begin(tree_, Hierarchy::over(place, tool_), trace_);
      const double dx = (place.x - centre.x) * unit, dy = (place.y - centre.y) * unit;
      list.run(tree_, search, float(dx), float(dy), float(slope.x * dx + slope.y * dy));
      contact = h_.end(tree_, search, trace_);
    });
    return true;
  }

  /// A lower bound of all heights over the rectangle, and the list of what may be above it.
  bool survey(Point centre, double half_x, double half_y, Point& slope, drop::Shortlist& list) const {
    const Tool tool = Hierarchy::over(centre, tool_);
    const drop::ToolSearch<Tool> first = h_.begin(tree_, tool, trace_);
    if (first.feature() == Terrain::none) return false;
    double least = 0;
    if (!bound_below(first, half_x, half_y, slope, least)) return false;
    const double unit = tree_.inverse_unit();
    auto survey = tree_.survey(
        tool, drop::ManyPlaces{drop::up(half_x * unit), drop::up(half_y * unit), float(slope.x), float(slope.y)});
    survey.raise(least);
    tree_.list(survey, list);
    return !list.overflowed();
  }

  /// A point that the ball about touches over the centre gives a lower bound of all heights over the rectangle: those of
  /// balls that touch this point, which form a sphere, a concave surface, so it lies above the least of its corners even after
  /// its tangent plane at the centre is taken off.
  bool bound_below(const drop::Search& first, double half_x, double half_y, Point& slope, double& bound) const {
    Hierarchy::Trace ignored;
    const Point centre = first.tool.place;
    const Point3 p = h_.end(tree_, first, ignored).point;
    const double ex = p.x - centre.x, ey = p.y - centre.y, squared = radius_ * radius_;
    const auto sphere = [&](double x, double y) { return squared - (ex - x) * (ex - x) - (ey - y) * (ey - y); };
    const double least =
        std::min({sphere(half_x, half_y), sphere(-half_x, half_y), sphere(half_x, -half_y), sphere(-half_x, -half_y)});
    if (least < 0.25 * squared) return false;
    const double rho = std::sqrt(sphere(0, 0));
    slope = {float(ex / rho), float(ey / rho)};
    const auto relative = [&](double x, double y) { return p.z + std::sqrt(sphere(x, y)) - slope.x * x - slope.y * y; };
    bound = std::min(
        {relative(half_x, half_y), relative(-half_x, half_y), relative(half_x, -half_y), relative(-half_x, -half_y)});
    return true;
  }

  /// So does the triangle that another tool touches, as far as it is touched over all four corners.
  bool bound_below(const drop::ProfileSearch& first, double half_x, double half_y, Point& slope, double& bound) const {
    const drop::Part part = tree_.part(first.part());
    const Point centre = first.tool.place, wanted = drop::touch_part(part, first.tool).slope;
    if (!(std::max(std::abs(wanted.x), std::abs(wanted.y)) <= steepest_shared)) return false;
    slope = {float(wanted.x), float(wanted.y)};
    bound = std::numeric_limits<double>::infinity();
    for (const Point off : {Point{half_x, half_y}, {-half_x, half_y}, {half_x, -half_y}, {-half_x, -half_y}}) {
      const double height =
          drop::touch_part(part, Hierarchy::over(Point{centre.x + off.x, centre.y + off.y}, first.tool)).height;
      if (height == drop::nothing) return false;
      bound = std::min(bound, height - slope.x * off.x - slope.y * off.y);
    }
    return true;
  }

  const Hierarchy& h_;
  const Tree& tree_;
  const Tool& tool_;
  const Raster& raster_;
  double radius_;
  std::span<Contact> contacts_;
  Hierarchy::Trace trace_;
};

Status DropCutter::at(const Raster& raster, std::span<Contact> contacts, const Context& context) const {
  const bool fits = raster.columns == 0 || raster.rows <= contacts.size() / raster.columns;
  if (!fits || contacts.size() != raster.columns * raster.rows) {
    return Error{ErrorCode::usage, "there is not one contact for each place of the raster", "", ""};
  }
  const double cell = hierarchy_->cell();
  const bool is_grid = terrain_->is_grid();
  const std::size_t side_x = together(raster.step_x, radius(), cell, is_grid);
  const std::size_t side_y = together(raster.step_y, radius(), cell, is_grid);
  const std::size_t across = (raster.columns + tile_side - 1) / tile_side,
                    up = (raster.rows + tile_side - 1) / tile_side;
  kernel::Progress progress(context, contacts.size());
  const bool done = kernel::parallel_blocks(context, across * up, 1, [&](std::size_t k, std::size_t) {
    const std::size_t column = k % across * tile_side, row = k / across * tile_side;
    const Patch tile{column, row, std::min(tile_side, raster.columns - column), std::min(tile_side, raster.rows - row)};
    with_tools([&]<class Tree, class Tool>(const Tree& tree, const Tool& tool) {
      TileWork<Tree, Tool>(*hierarchy_, tree, tool, raster, contacts).run(tile, side_x, side_y);
    });
    progress.add(tile.columns * tile.rows);
  });
  if (!done) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  return std::monostate{};
}

}  // namespace krepl
