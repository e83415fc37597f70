// The lowest level of the pyramid: cells and triangles straight from the samples.
#include <cmath>
#include <limits>

#include "terrain/drop_cutter_grid.hpp"

namespace krepl::drop {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();
constexpr float lanes[4] = {0, 1, 2, 3};

}  // namespace

/// Samples first .. first + 3 of a row and their neighbours in +x; missing beyond the grid.
void GridPyramid::load(std::size_t column, std::size_t row, Float4& here, Float4& east) const {
  const Float4 scale = float(scale_.inverse_unit);
  if (column + arity < columns_) [[likely]] {
    const double* z = heights_ + row * columns_ + column;
    here = Float4::from_doubles(z) * scale, east = Float4::from_doubles(z + 1) * scale;
    return;
  }
  double z[arity + 1];
  for (std::size_t k = 0; k <= arity; ++k) z[k] = column + k < columns_ ? heights_[row * columns_ + column + k] : missing;
  here = Float4::from_doubles(z) * scale, east = Float4::from_doubles(z + 1) * scale;
}

/// Bounds of cells as blocks; returns which are worth a look, as bits.
template <class Query>
unsigned GridPyramid::bound_cells(const Query& query, std::size_t column, std::size_t first_row, std::size_t last_row,
                                  float* bounds) const {
  const double x = (t_.grid_x(column) - query.ball.place.x) * scale_.inverse_unit;
  const double y = (t_.grid_y(first_row) - query.ball.place.y) * scale_.inverse_unit;
  const Float4 half_by_x = 0.5f / width_, half_by_y = 0.5f / height_, lowest = -float_infinity;
  FourBlocks p;
  p.x0 = Float4(float(x)) + Float4::load(lanes) * Float4(width_), p.x1 = p.x0 + Float4(width_);
  Float4 south, south_east, north, north_east;
  load(column, first_row, south, south_east);
  unsigned worth = 0;
  for (std::size_t row = first_row; row <= last_row; ++row, south = north, south_east = north_east) {
    load(column, row + 1, north, north_east);
    p.y0 = float(y) + float(row - first_row) * height_, p.y1 = p.y0 + Float4(height_);
    // The bilinear surface through four samples is off their best plane by a quarter of its twist.
    const Float4 twist = south + north_east - south_east - north;
    const Float4 sum = south + north_east + south_east + north;
    const Float4 slope_x = (south_east + north_east - south - north) * half_by_x;
    const Float4 slope_y = (north + north_east - south - south_east) * half_by_y;
    const Float4 usable = (Float4(steepest) >= absolute(slope_x)) & (Float4(steepest) >= absolute(slope_y));
    if (complete_ && column + arity < columns_) [[likely]] {
      p.top = max(max(south, south_east), max(north, north_east));
    } else {
      const auto known = [&](Float4 z) { return select(is_number(z), z, lowest); };
      p.top = max(max(known(south), known(south_east)), max(known(north), known(north_east)));
    }
    p.level = select(usable, Float4(0.25f) * (sum + absolute(twist)), p.top);
    p.slope_x = select(usable, slope_x, Float4(0.f)), p.slope_y = select(usable, slope_y, Float4(0.f));
    worth |= query.worth(p, bounds + 4 * (row - first_row)) << (4 * (row - first_row));
  }
  return worth;
}

/// The triangles of one or two cells, the lower one of each first.
FourTriangles GridPyramid::triangles(Point place, const Index* cells, std::size_t count) const {
  float top[4], z[4], slope_x[4], slope_y[4], x[3][4], y[3][4];
  const double unit = scale_.inverse_unit;
  for (unsigned lane = 0; lane < 4; ++lane) {
    const std::size_t sample = cells[lane / 2 < count ? lane / 2 : 0], column = sample % columns_, row = sample / columns_;
    const bool upper = lane % 2 == 1;
    const TerrainAccess::Cell here = cell(column, row);
    const auto& corner = corners_of(here.falling, upper);
    const double* h = heights_ + sample;
    const double height[4] = {h[0], h[1], h[columns_], h[columns_ + 1]};
    const float places_x[2] = {float((t_.grid_x(column) - place.x) * unit), float((t_.grid_x(column + 1) - place.x) * unit)};
    const float places_y[2] = {float((t_.grid_y(row) - place.y) * unit), float((t_.grid_y(row + 1) - place.y) * unit)};
    for (unsigned k = 0; k < 3; ++k) x[k][lane] = places_x[corner[k] % 2], y[k][lane] = places_y[corner[k] / 2];
    const double highest = std::max({height[corner[0]], height[corner[1]], height[corner[2]]});
    top[lane] = z[lane] = lane / 2 < count && (upper ? here.upper : here.lower) ? float(highest * unit) : -float_infinity;
    slope_x[lane] = slope_y[lane] = 0;
    // Each has a leg along x, in the south or the north, and one along y, in the west or the east.
    const bool east = here.falling == upper;
    const float along_x = float((upper ? height[3] - height[2] : height[1] - height[0]) * inverse_cell_.x);
    const float along_y = float((east ? height[3] - height[1] : height[2] - height[0]) * inverse_cell_.y);
    if (!(std::abs(along_x) <= steepest && std::abs(along_y) <= steepest) || top[lane] == -float_infinity) continue;
    z[lane] = float(height[corner[0]] * unit), slope_x[lane] = along_x, slope_y[lane] = along_y;
  }
  const auto load = [](const float* f) { return Float4::load(f); };
  return {load(top), load(z), load(slope_x), load(slope_y), load(x[0]), load(y[0]), load(x[1]), load(y[1]), load(x[2]), load(y[2])};
}

void GridPyramid::visit_cells(Search& search, std::size_t column, std::size_t first_row, std::size_t last_row) const {
  float bounds[32];
  Candidates<32> found;
  for (unsigned worth = bound_cells(search, column, first_row, last_row, bounds); worth != 0; worth &= worth - 1) {
    const unsigned cell = unsigned(__builtin_ctz(worth));
    if (column + cell % 4 + 1 < columns_) found.add(bounds[cell], Index((first_row + cell / 4) * columns_ + column + cell % 4));
  }
  for (auto entry = found.begin(); entry < found.end() && entry->bound >= search.threshold_of_blocks(); entry += 2) {
    const std::size_t count = std::min<std::size_t>(2, std::size_t(found.end() - entry));
    const Index cells[2] = {entry->column, entry[count - 1].column};
    Candidates<4> four;
    for (unsigned worth = search.worth(triangles(search.ball.place, cells, count), bounds); worth != 0; worth &= worth - 1) {
      const unsigned lane = unsigned(__builtin_ctz(worth));
      four.add(bounds[lane], 2 * cells[lane / 2] + lane % 2);
    }
    for (const auto& triangle : four)
      if (triangle.bound >= search.threshold_of_triangles()) touch(search, triangle.column);
  }
}

void GridPyramid::list_cells(const Survey& survey, std::size_t column, std::size_t first_row, std::size_t last_row,
                             Shortlist& shortlist) const {
  float bounds[32];
  Index cells[32];
  std::size_t count = 0;
  for (unsigned worth = bound_cells(survey, column, first_row, last_row, bounds); worth != 0; worth &= worth - 1) {
    const unsigned cell = unsigned(__builtin_ctz(worth));
    if (column + cell % 4 + 1 < columns_) cells[count++] = Index((first_row + cell / 4) * columns_ + column + cell % 4);
  }
  for (std::size_t i = 0; i < count; i += 2) {
    const FourTriangles four = triangles(survey.ball.place, cells + i, std::min<std::size_t>(2, count - i));
    shortlist.add(four, survey.worth(four, bounds), [&](unsigned lane) { return 2 * cells[i + lane / 2] + lane % 2; });
  }
}

void GridPyramid::touch(Search& search, Index triangle) const {
  if (triangle != search.skip) search.touch(part(triangle), triangle);
}

Part GridPyramid::part(Index triangle) const {
  const Index columns = Index(columns_), s = triangle / 2, north = s + columns, east = s + 1;
  const std::size_t column = s % columns_, row = s / columns_;
  const bool upper = triangle % 2 == 1, falling = cell(column, row).falling;
  const Index sample[4] = {s, east, north, north + 1};
  const double x[2] = {t_.grid_x(column), t_.grid_x(column + 1)}, y[2] = {t_.grid_y(row), t_.grid_y(row + 1)};
  Part p;
  const auto& corner = corners_of(falling, upper);
  for (unsigned k = 0; k < 3; ++k) {
    p.corner[k] = {x[corner[k] % 2], y[corner[k] / 2], heights_[sample[corner[k]]]};
    p.vertex[k] = 6 * sample[corner[k]];
  }
  const Index along_x = 6 * (upper ? north : s) + 1, along_y = 6 * (falling == upper ? east : s) + 2, diagonal = 6 * s + 3;
  if (upper && falling) p.edge = {along_y, along_x, diagonal};
  else if (upper) p.edge = {diagonal, along_x, along_y};
  else if (falling) p.edge = {along_x, diagonal, along_y};
  else p.edge = {along_x, along_y, diagonal};
  p.face = 6 * s + (upper ? 5 : 4);
  p.vertical = false;
  return p;
}

Index GridPyramid::triangle_at(Point p) const {
  const double x = (p.x - grid_.first.x) * inverse_cell_.x, y = (p.y - grid_.first.y) * inverse_cell_.y;
  if (!(x >= 0 && y >= 0 && x < double(columns_ - 1) && y < double(rows_ - 1))) return Terrain::none;
  const std::size_t column = std::size_t(x), row = std::size_t(y);
  const double s = x - double(column), t = y - double(row);
  const TerrainAccess::Cell here = cell(column, row);
  const bool upper = here.falling ? s + t > 1 : t > s;
  if (!(upper ? here.upper : here.lower)) return Terrain::none;
  return Index(2 * (row * columns_ + column) + upper);
}

}  // namespace krepl::drop
