#include "terrain/drop_cutter_grid.hpp"

#include <cmath>
#include <limits>

#include "kernel/parallel.hpp"

namespace krepl::drop {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::size_t groups(std::size_t n, std::size_t size) { return (n + size - 1) / size; }
/// Cells a side of a block of the given level.
std::size_t block_cells(std::size_t level) { return std::size_t{4} << (2 * level); }

constexpr float lanes[4] = {0, 1, 2, 3};

}  // namespace

GridPyramid::GridPyramid(const Terrain& terrain, const Scale& scale, const Context& context)
    : t_(terrain), heights_(t_.heights().data()), grid_(terrain.grid()), scale_(scale), columns_(grid_.columns),
      rows_(grid_.rows), inverse_cell_{1 / grid_.cell_x, 1 / grid_.cell_y}, width_(float(grid_.cell_x * scale.inverse_unit)),
      height_(float(grid_.cell_y * scale.inverse_unit)), complete_(terrain.report().missing_samples == 0) {
  std::size_t blocks_across = groups(columns_ - 1, arity), blocks_up = groups(rows_ - 1, arity);
  do {
    Level level;
    level.columns = groups(blocks_across, arity), level.rows = groups(blocks_up, arity);
    level.nodes.resize(level.columns * level.rows);
    blocks_across = level.columns, blocks_up = level.rows;
    levels_.push_back(std::move(level));
    build_level(levels_.size() - 1, context);
  } while (blocks_across > 1 || blocks_up > 1);
}

void GridPyramid::build_level(std::size_t level, const Context& context) {
  Level& l = levels_[level];
  const std::size_t node_samples = block_cells(level + 1) * block_cells(level + 1);
  const std::size_t portion = std::max<std::size_t>(1, (std::size_t{1} << 16) / node_samples);
  kernel::parallel_blocks(context, l.nodes.size(), portion, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      for (std::size_t child = 0; child < 16; ++child) {
        const std::size_t column = n % l.columns * arity + child % arity, row = n / l.columns * arity + child / arity;
        bound_block(level, column, row, l.nodes[n], child);
      }
  });
}

/// The highest sample of a block, and a plane above all its samples: of the slope that fits them best, if none is missing.
void GridPyramid::bound_block(std::size_t level, std::size_t column, std::size_t row, Node& node, std::size_t child) const {
  const std::size_t size = block_cells(level), i0 = column * size, j0 = row * size;
  const std::size_t i1 = std::min(i0 + size, columns_ - 1), j1 = std::min(j0 + size, rows_ - 1);
  node.top[child] = node.level[child] = -float_infinity;
  node.slope_x[child] = node.slope_y[child] = 0;
  if (i0 + 1 >= columns_ || j0 + 1 >= rows_) return;
  double top = -infinity, sum_x = 0, sum_y = 0;
  const double middle_i = 0.5 * double(i0 + i1), middle_j = 0.5 * double(j0 + j1);
  for (std::size_t j = j0; j <= j1; ++j) {
    const double* z = heights_ + j * columns_;
    double sum = 0;
    for (std::size_t i = i0; i <= i1; ++i) {
      top = std::max(top, z[i]);  // a missing sample is not greater
      sum += z[i], sum_x += (double(i) - middle_i) * z[i];
    }
    sum_y += (double(j) - middle_j) * sum;
  }
  if (top == -infinity) return;
  node.top[child] = node.level[child] = up(top * scale_.inverse_unit);
  // The sum of the squares of n equidistant numbers about their middle is n (n^2 - 1) / 12.
  const double across = double(i1 - i0 + 1), along = double(j1 - j0 + 1);
  const double squares_x = across * (across * across - 1) / 12 * along, squares_y = along * (along * along - 1) / 12 * across;
  const float slope_x = float(sum_x / squares_x / grid_.cell_x), slope_y = float(sum_y / squares_y / grid_.cell_y);
  if (!(std::abs(slope_x) <= steepest && std::abs(slope_y) <= steepest)) return;  // too steep, or NaN: a sample is missing
  const double dx = slope_x * grid_.cell_x, dy = slope_y * grid_.cell_y;
  double level_at_first = -infinity;
  for (std::size_t j = j0; j <= j1; ++j) {
    const double* z = heights_ + j * columns_;
    for (std::size_t i = i0; i <= i1; ++i)
      level_at_first = std::max(level_at_first, z[i] - dx * double(i - i0) - dy * double(j - j0));
  }
  const double width = double(size) * grid_.cell_x, height = double(size) * grid_.cell_y;
  const double at_middle = level_at_first + 0.5 * (slope_x * width + slope_y * height);
  node.level[child] = up((at_middle + bound_rounding(width, height, slope_x, slope_y)) * scale_.inverse_unit);
  node.slope_x[child] = slope_x, node.slope_y[child] = slope_y;
}

/// Coordinates are relative to the place. Blocks where the search starts are at most four times as wide as the ball.
Moved GridPyramid::moved(Point place, double radius) const {
  const double farthest = std::abs(place.x) + std::abs(place.y) + 10 * scale_.extent;
  const double cell = std::max(grid_.cell_x, grid_.cell_y);
  return {0x1p-23 * std::min(10 * radius + 17 * cell, farthest), 0x1p-22 * std::min(radius + 10 * cell, farthest)};
}

template <class Query>
bool GridPyramid::reach(const Query& query, double margin_x, double margin_y, Reach& reach) const {
  const auto range = [](double low, double high, std::size_t count, std::size_t& first, std::size_t& last) {
    low -= 0x1p-40 * (std::abs(low) + 1), high += 0x1p-40 * (std::abs(high) + 1);
    if (!(high >= 0 && low <= double(count))) return false;
    first = std::min(std::size_t(std::max(0.0, low)), count - 1);
    last = std::min(std::size_t(std::min(high, double(count))), count - 1);
    return true;
  };
  const double x = query.tool.place.x - grid_.first.x, y = query.tool.place.y - grid_.first.y;
  const double rx = query.tool.radius + margin_x, ry = query.tool.radius + margin_y;
  return range((x - rx) * inverse_cell_.x, (x + rx) * inverse_cell_.x, columns_ - 1, reach.first_column,
               reach.last_column) &&
         range((y - ry) * inverse_cell_.y, (y + ry) * inverse_cell_.y, rows_ - 1, reach.first_row, reach.last_row);
}

bool GridPyramid::is_small(const Reach& reach) {
  return reach.last_column - reach.first_column < arity && reach.last_row - reach.first_row < 8;
}

template <class Visit>
void GridPyramid::start(const Reach& reach, const Visit& visit) const {
  std::size_t level = 0;
  const auto nodes = [&](std::size_t a, std::size_t b) { return b / block_cells(level + 1) - a / block_cells(level + 1); };
  while (level + 1 < levels_.size() &&
         (nodes(reach.first_column, reach.last_column) > 1 || nodes(reach.first_row, reach.last_row) > 1)) {
    ++level;
  }
  const std::size_t size = block_cells(level + 1);
  for (std::size_t row = reach.first_row / size; row <= reach.last_row / size; ++row)
    for (std::size_t column = reach.first_column / size; column <= reach.last_column / size; ++column)
      visit(level, column, row);
}

template <class Query>
unsigned GridPyramid::bound_children(const Query& query, const Reach& reach, std::size_t level, std::size_t column,
                                     std::size_t row, float* bounds) const {
  const std::size_t size = block_cells(level), i = column * arity, j = row * arity;
  const Node& node = levels_[level].nodes[row * levels_[level].columns + column];
  const std::size_t r0 = reach.first_row / size > j ? reach.first_row / size - j : 0;
  const std::size_t r1 = std::min(arity - 1, reach.last_row / size - j);
  FourBlocks p;
  const float width = float(size) * width_, height = float(size) * height_;
  const double x = (grid_.first.x + double(i * size) * grid_.cell_x - query.tool.place.x) * scale_.inverse_unit;
  const double y = (grid_.first.y + double(j * size) * grid_.cell_y - query.tool.place.y) * scale_.inverse_unit;
  p.x0 = Float4(float(x)) + Float4::load(lanes) * Float4(width);
  p.x1 = p.x0 + Float4(width);
  unsigned worth = 0;
  for (std::size_t r = r0; r <= r1; ++r) {
    p.y0 = float(y) + float(r) * height;
    p.y1 = p.y0 + Float4(height);
    p.top = Float4::load(node.top + 4 * r), p.level = Float4::load(node.level + 4 * r);
    p.slope_x = Float4::load(node.slope_x + 4 * r), p.slope_y = Float4::load(node.slope_y + 4 * r);
    worth |= query.worth(p, bounds + 4 * r) << (4 * r);
  }
  return worth;
}

template <class Search>
void GridPyramid::run(Search& search) const {
  Reach reach;
  if (!this->reach(search, 0, 0, reach)) return;
  if (is_small(reach)) return visit_cells(search, reach.first_column, reach.first_row, reach.last_row);
  Candidates<64> found;
  std::size_t level = 0;
  start(reach, [&](std::size_t l, std::size_t column, std::size_t row) {
    level = l;
    add_children(search, reach, level, column, row, found);
  });
  visit(search, reach, level, found);
}

template <class Search, std::size_t capacity>
void GridPyramid::add_children(const Search& search, const Reach& reach, std::size_t level, std::size_t column,
                               std::size_t row, Candidates<capacity>& found) const {
  float bounds[16];
  for (unsigned worth = bound_children(search, reach, level, column, row, bounds); worth != 0; worth &= worth - 1) {
    const unsigned child = unsigned(__builtin_ctz(worth));
    found.add(bounds[child], Index(column * arity + child % 4), Index(row * arity + child / 4));
  }
}

template <class Search, std::size_t capacity>
void GridPyramid::visit(Search& search, const Reach& reach, std::size_t level,
                        const Candidates<capacity>& found) const {
  for (const auto& entry : found) {
    if (entry.bound < search.threshold_of_blocks()) return;
    if (level == 0) {
      const std::size_t row = entry.row * arity;
      visit_cells(search, entry.column * arity, std::max(row, reach.first_row), std::min(row + arity - 1, reach.last_row));
      continue;
    }
    Candidates<16> below;
    add_children(search, reach, level - 1, entry.column, entry.row, below);
    visit(search, reach, level - 1, below);
  }
}

template void GridPyramid::run(Search&) const;
template void GridPyramid::run(ProfileSearch&) const;

template <class Survey, class List>
void GridPyramid::list(const Survey& survey, List& shortlist) const {
  Reach reach;
  const double half_x = survey.spread.half_x / scale_.inverse_unit, half_y = survey.spread.half_y / scale_.inverse_unit;
  if (!this->reach(survey, half_x, half_y, reach)) return;
  if (is_small(reach)) {
    list_cells(survey, reach.first_column, reach.first_row, reach.last_row, shortlist);
  } else {
    start(reach, [&](std::size_t level, std::size_t column, std::size_t row) {
      list_node(survey, reach, level, column, row, shortlist);
    });
  }
  shortlist.close();
}

template <class Survey, class List>
void GridPyramid::list_node(const Survey& survey, const Reach& reach, std::size_t level, std::size_t column, std::size_t row,
                            List& shortlist) const {
  float bounds[16];
  for (unsigned worth = bound_children(survey, reach, level, column, row, bounds); worth != 0; worth &= worth - 1) {
    if (shortlist.overflowed()) return;
    const unsigned child = unsigned(__builtin_ctz(worth));
    const std::size_t i = column * arity + child % 4, j = row * arity + child / 4;
    if (level > 0) {
      list_node(survey, reach, level - 1, i, j, shortlist);
    } else {
      list_cells(survey, i * arity, std::max(j * arity, reach.first_row),
                 std::min(j * arity + arity - 1, reach.last_row), shortlist);
    }
  }
}

template void GridPyramid::list(const Survey&, Shortlist&) const;
template void GridPyramid::list(const ProfileSurvey&, Shortlist&) const;
template void GridPyramid::list(const Survey&, LongList&) const;
template void GridPyramid::list(const ProfileSurvey&, LongList&) const;

}  // namespace krepl::drop
