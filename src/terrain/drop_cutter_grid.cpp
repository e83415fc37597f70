#include "terrain/drop_cutter_grid.hpp"

#include <cmath>
#include <limits>

#include "kernel/parallel.hpp"

namespace krepl::drop {
namespace {

using Kind = Terrain::FeatureKind;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double missing = std::numeric_limits<double>::quiet_NaN();

std::size_t groups(std::size_t n, std::size_t size) { return (n + size - 1) / size; }
/// Cells a side of a block of the given level.
std::size_t block_cells(std::size_t level) { return std::size_t{4} << (2 * level); }

Float4 absolute(Float4 a) { return max(a, Float4(0.f) - a); }

}  // namespace

GridPyramid::GridPyramid(const Terrain& terrain, const Scale& scale, const Context& context)
    : t_(terrain), heights_(t_.heights().data()), grid_(terrain.grid()), scale_(scale), columns_(grid_.columns),
      rows_(grid_.rows), inverse_cell_{1 / grid_.cell_x, 1 / grid_.cell_y}, width_(float(grid_.cell_x * scale.inverse_unit)),
      height_(float(grid_.cell_y * scale.inverse_unit)), complete_(terrain.report().missing_samples == 0) {
  std::size_t blocks_across = groups(columns_, arity), blocks_up = groups(rows_, arity);
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
  if (i0 >= columns_ || j0 >= rows_) return;
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
  const float slope_x = squares_x > 0 ? float(sum_x / squares_x / grid_.cell_x) : 0;
  const float slope_y = squares_y > 0 ? float(sum_y / squares_y / grid_.cell_y) : 0;
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

Search GridPyramid::search(Point place, double radius) const {
  // Coordinates are relative to the place; blocks where the search starts are at most four times as wide as the ball.
  const double farthest = std::min(10 * radius + 17 * std::max(grid_.cell_x, grid_.cell_y),
                                   std::abs(place.x) + std::abs(place.y) + 10 * scale_.extent);
  return Search(scale_, place, radius, 0x1p-21 * farthest);
}

Index GridPyramid::part_at(Point p) const {
  const double i = std::floor((p.x - grid_.first.x) * inverse_cell_.x), j = std::floor((p.y - grid_.first.y) * inverse_cell_.y);
  if (!(i >= 0 && j >= 0 && i < double(columns_) && j < double(rows_))) return Terrain::none;
  return Index(std::size_t(j) * columns_ + std::size_t(i));
}

bool GridPyramid::reach(const Search& search, Reach& reach) const {
  const auto range = [&](double place, double origin, double inverse, std::size_t count, std::size_t& first, std::size_t& last) {
    double low = (place - search.ball.radius - origin) * inverse, high = (place + search.ball.radius - origin) * inverse;
    low -= 0x1p-40 * (std::abs(low) + 1), high += 0x1p-40 * (std::abs(high) + 1);
    if (!(high >= 0 && low <= double(count))) return false;
    first = std::size_t(std::max(0.0, low)), last = std::size_t(std::min(high, double(count)));
    first = std::min(first, count - 1), last = std::min(last, count - 1);
    return true;
  };
  return range(search.ball.place.x, grid_.first.x, inverse_cell_.x, columns_, reach.first_column, reach.last_column) &&
         range(search.ball.place.y, grid_.first.y, inverse_cell_.y, rows_, reach.first_row, reach.last_row);
}

void GridPyramid::run(Search& search, Index first) const {
  Reach reach;
  if (!this->reach(search, reach)) return;
  if (first != Terrain::none) {
    touch_cell(search, first % columns_, first / columns_);
    search.skip = first;
  }
  if (reach.last_column - reach.first_column < arity && reach.last_row - reach.first_row < 8) {
    return visit_cells(search, reach.first_column, reach.first_row, reach.last_row);
  }
  std::size_t level = 0;
  const auto nodes = [&](std::size_t a, std::size_t b) { return b / block_cells(level + 1) - a / block_cells(level + 1); };
  while (level + 1 < levels_.size() &&
         (nodes(reach.first_column, reach.last_column) > 1 || nodes(reach.first_row, reach.last_row) > 1)) {
    ++level;
  }
  const std::size_t size = block_cells(level + 1);
  Candidates<64> found;
  for (std::size_t row = reach.first_row / size; row <= reach.last_row / size; ++row)
    for (std::size_t column = reach.first_column / size; column <= reach.last_column / size; ++column)
      add_children(search, reach, level, column, row, found);
  visit(search, reach, level, found);
}

/// Adds the blocks of a node that may hold the highest touch.
template <std::size_t capacity>
void GridPyramid::add_children(const Search& search, const Reach& reach, std::size_t level, std::size_t column,
                               std::size_t row, Candidates<capacity>& found) const {
  const std::size_t size = block_cells(level), i = column * arity, j = row * arity;
  const Node& node = levels_[level].nodes[row * levels_[level].columns + column];
  const std::size_t r0 = reach.first_row / size > j ? reach.first_row / size - j : 0;
  const std::size_t r1 = std::min(arity - 1, reach.last_row / size - j);
  FourParts p;
  const float width = float(size) * width_, height = float(size) * height_;
  static constexpr float lanes[4] = {0, 1, 2, 3};
  const double x = (grid_.first.x + double(i * size) * grid_.cell_x - search.ball.place.x) * scale_.inverse_unit;
  const double y = (grid_.first.y + double(j * size) * grid_.cell_y - search.ball.place.y) * scale_.inverse_unit;
  p.x0 = Float4(float(x) - search.blur) + Float4::load(lanes) * Float4(width);
  p.x1 = p.x0 + Float4(width + 2 * search.blur);
  // All bounds first: a branch after each would cost more than they do.
  float bounds[16];
  unsigned worth = 0;
  for (std::size_t r = r0; r <= r1; ++r) {
    p.y0 = float(y) - search.blur + float(r) * height;
    p.y1 = p.y0 + Float4(height + 2 * search.blur);
    p.top = Float4::load(node.top + 4 * r), p.level = Float4::load(node.level + 4 * r);
    p.slope_x = Float4::load(node.slope_x + 4 * r), p.slope_y = Float4::load(node.slope_y + 4 * r);
    const Float4 b = bound(search.bounds, p);
    b.store(bounds + 4 * r);
    worth |= bits(b >= Float4(search.threshold())) << (4 * r);
  }
  for (; worth != 0; worth &= worth - 1) {
    const unsigned child = unsigned(__builtin_ctz(worth));
    found.add(bounds[child], Index(i + child % 4), Index(j + child / 4));
  }
}

template <std::size_t capacity>
void GridPyramid::visit(Search& search, const Reach& reach, std::size_t level, const Candidates<capacity>& found) const {
  for (const auto& entry : found) {
    if (entry.bound < search.threshold()) return;
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

/// Samples first .. first + 3 of a row and their neighbours in +x; missing beyond the grid.
void GridPyramid::load(std::size_t column, std::size_t row, Float4& here, Float4& east) const {
  const Float4 scale = float(scale_.inverse_unit);
  if (row < rows_ && column + arity < columns_) [[likely]] {
    const double* z = heights_ + row * columns_ + column;
    here = Float4::from_doubles(z) * scale, east = Float4::from_doubles(z + 1) * scale;
    return;
  }
  double z[arity + 1];
  for (std::size_t k = 0; k <= arity; ++k) {
    z[k] = row < rows_ && column + k < columns_ ? heights_[row * columns_ + column + k] : missing;
  }
  here = Float4::from_doubles(z) * scale, east = Float4::from_doubles(z + 1) * scale;
}

/// Four cells a row, from first_row to last_row (8 rows at most).
void GridPyramid::visit_cells(Search& search, std::size_t column, std::size_t first_row, std::size_t last_row) const {
  static constexpr float lanes[4] = {0, 1, 2, 3};
  const double x = (t_.grid_x(column) - search.ball.place.x) * scale_.inverse_unit;
  const double y = (t_.grid_y(first_row) - search.ball.place.y) * scale_.inverse_unit;
  const Float4 half_by_x = 0.5f / width_, half_by_y = 0.5f / height_, lowest = -float_infinity;
  FourParts p;
  p.x0 = Float4(float(x) - search.blur) + Float4::load(lanes) * Float4(width_);
  p.x1 = p.x0 + Float4(width_ + 2 * search.blur);
  Float4 south, south_east, north, north_east;
  load(column, first_row, south, south_east);
  float bounds[32];
  unsigned worth = 0;
  for (std::size_t row = first_row; row <= last_row; ++row, south = north, south_east = north_east) {
    load(column, row + 1, north, north_east);
    p.y0 = float(y) - search.blur + float(row - first_row) * height_;
    p.y1 = p.y0 + Float4(height_ + 2 * search.blur);
    // The bilinear surface through four samples is off their best plane by a quarter of its twist.
    const Float4 twist = south + north_east - south_east - north;
    const Float4 sum = south + north_east + south_east + north;
    const Float4 slope_x = (south_east + north_east - south - north) * half_by_x;
    const Float4 slope_y = (north + north_east - south - south_east) * half_by_y;
    const Float4 usable = (Float4(steepest) >= absolute(slope_x)) & (Float4(steepest) >= absolute(slope_y));
    if (bits(is_number(twist)) == 15) {
      p.top = max(max(south, south_east), max(north, north_east));
    } else {
      const auto known = [&](Float4 z) { return select(is_number(z), z, lowest); };
      p.top = max(max(known(south), known(south_east)), max(known(north), known(north_east)));
    }
    p.level = select(usable, Float4(0.25f) * (sum + absolute(twist)), p.top);
    p.slope_x = select(usable, slope_x, Float4(0.f)), p.slope_y = select(usable, slope_y, Float4(0.f));
    const Float4 b = bound(search.bounds, p);
    b.store(bounds + 4 * (row - first_row));
    worth |= bits(b >= Float4(search.threshold())) << (4 * (row - first_row));
  }
  Candidates<32> found;
  for (; worth != 0; worth &= worth - 1) {
    const unsigned cell = unsigned(__builtin_ctz(worth));
    found.add(bounds[cell], Index(column + cell % 4), Index(first_row + cell / 4));
  }
  for (const auto& entry : found) {
    if (entry.bound < search.threshold()) return;
    touch_cell(search, entry.column, entry.row);
  }
}

}  // namespace krepl::drop
