// The lowest level of the pyramid: cells and triangles straight from the samples.
#include <cmath>
#include <limits>

#include "terrain/drop_cutter_grid.hpp"

namespace krepl::drop {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();
constexpr float lanes[4] = {0, 1, 2, 3};

/// A triangle as terrain_grid.cpp numbers it. Corners: 0 the cell's sample, 1 in +x, 2 in +y, 3 in both. Side k, from corner k
/// to the next, is the edge of kind 1 (to +x), 2 (to +y) or 3 (the diagonal) of the sample at a corner.
struct Shape {
  unsigned corner[3], edge_from[3], edge_kind[3];
};
const Shape& shape_of(bool falling, bool upper) {
  static constexpr Shape shapes[2][2] = {{{{0, 1, 3}, {0, 1, 0}, {1, 2, 3}}, {{0, 3, 2}, {0, 2, 0}, {3, 1, 2}}},
                                         {{{0, 1, 2}, {0, 0, 0}, {1, 3, 2}}, {{1, 3, 2}, {1, 2, 0}, {2, 1, 3}}}};
  return shapes[falling][upper];
}

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

/// Four cells of a row.
struct GridPyramid::FourCells {
  Float4 sw, se, nw, ne;  // heights of their corners
  Float4 x0, x1, y0, y1;  // relative to the place
  Float4 falling;         // a mask
  bool whole;             // no corner is missing
};

/// As blocks: the bilinear surface through four samples is off their best plane by a quarter of its twist.
FourBlocks GridPyramid::blocks(const FourCells& c) const {
  const Float4 twist = c.sw + c.ne - c.se - c.nw, sum = c.sw + c.ne + c.se + c.nw;
  const Float4 slope_x = (c.se + c.ne - c.sw - c.nw) * Float4(0.5f / width_);
  const Float4 slope_y = (c.nw + c.ne - c.sw - c.se) * Float4(0.5f / height_);
  const Float4 usable = (Float4(steepest) >= absolute(slope_x)) & (Float4(steepest) >= absolute(slope_y));  // not if NaN
  const auto known = [&](Float4 z) { return c.whole ? z : select(is_number(z), z, Float4(-float_infinity)); };
  const Float4 top = max(max(known(c.sw), known(c.se)), max(known(c.nw), known(c.ne)));
  return {top, select(usable, Float4(0.25f) * (sum + absolute(twist)), top), select(usable, slope_x, Float4(0.f)),
          select(usable, slope_y, Float4(0.f)), c.x0, c.x1, c.y0, c.y1};
}

/// Their lower or upper triangles. Each has a leg along x, in the south or the north, and one along y, in the west or the
/// east.
FourTriangles GridPyramid::triangles(const FourCells& c, bool upper) const {
  const Float4 west = c.nw - c.sw, east = c.ne - c.se;
  Float4 slope_x = (upper ? c.ne - c.nw : c.se - c.sw) * Float4(1 / width_);
  Float4 slope_y = (upper ? select(c.falling, east, west) : select(c.falling, west, east)) * Float4(1 / height_);
  const Float4 first = upper ? select(c.falling, c.se, c.sw) : c.sw, second = upper ? c.ne : c.se;
  const Float4 third = upper ? c.nw : select(c.falling, c.nw, c.ne);
  Float4 top = max(max(first, second), third);
  if (!c.whole) top = select(is_number(first + second + third), top, Float4(-float_infinity));
  const Float4 usable = (Float4(steepest) >= absolute(slope_x)) & (Float4(steepest) >= absolute(slope_y));
  const Float4 z = select(usable, first, top);
  slope_x = select(usable, slope_x, Float4(0.f)), slope_y = select(usable, slope_y, Float4(0.f));
  if (upper) return {top, z, slope_x, slope_y, select(c.falling, c.x1, c.x0), c.y0, c.x1, c.y1, c.x0, c.y1};
  return {top, z, slope_x, slope_y, c.x0, c.y0, c.x1, c.y0, select(c.falling, c.x0, c.x1), c.y1};
}

Float4 GridPyramid::falling(std::size_t column, std::size_t row) const {
  if (grid_.split != Terrain::Split::shorter) return Float4(grid_.split == Terrain::Split::falling ? 1.f : 0.f) >= Float4(0.5f);
  float falls[arity];
  for (std::size_t k = 0; k < arity; ++k) falls[k] = column + k + 1 < columns_ && t_.cell(column + k, row).falling ? 1.f : 0.f;
  return Float4::load(falls) >= Float4(0.5f);
}

/// Calls each(four, worth, bounds, first triangle) for triangles of cells that are worth a look, the numbers of triangles in
/// the lanes being first, first + 2, ...
template <class Query, class Each>
void GridPyramid::for_each_triangle(const Query& query, std::size_t column, std::size_t first_row, std::size_t last_row,
                                    const Each& each) const {
  const double x = (t_.grid_x(column) - query.tool.place.x) * scale_.inverse_unit;
  const double y = (t_.grid_y(first_row) - query.tool.place.y) * scale_.inverse_unit;
  FourCells c;
  c.x0 = Float4(float(x)) + Float4::load(lanes) * Float4(width_), c.x1 = c.x0 + Float4(width_);
  c.whole = complete_ && column + arity < columns_;
  const unsigned inside = column + arity < columns_ ? 15u : (1u << (columns_ - 1 - column)) - 1;
  load(column, first_row, c.sw, c.se);
  for (std::size_t row = first_row; row <= last_row; ++row, c.sw = c.nw, c.se = c.ne) {
    load(column, row + 1, c.nw, c.ne);
    c.y0 = float(y) + float(row - first_row) * height_, c.y1 = c.y0 + Float4(height_);
    float bounds[4];
    const unsigned cells = inside & query.worth(blocks(c), bounds);
    if (cells == 0) continue;
    c.falling = falling(column, row);
    for (const bool upper : {false, true}) {
      const FourTriangles four = triangles(c, upper);
      const unsigned worth = cells & query.worth(four, bounds);
      each(four, worth, bounds, Index(2 * (row * columns_ + column) + upper));
    }
  }
}

template <class Search>
void GridPyramid::visit_cells(Search& search, std::size_t column, std::size_t first_row, std::size_t last_row) const {
  Candidates<64> found;
  for_each_triangle(search, column, first_row, last_row,
                    [&](const FourTriangles&, unsigned worth, const float* bounds, Index first) {
                      for (; worth != 0; worth &= worth - 1) {
                        const unsigned lane = unsigned(__builtin_ctz(worth));
                        found.add(bounds[lane], first + 2 * lane);
                      }
                    });
  for (const auto& entry : found) {
    if (entry.bound < search.threshold_of_triangles()) return;
    touch(search, entry.column);
  }
}

template void GridPyramid::visit_cells(Search&, std::size_t, std::size_t, std::size_t) const;
template void GridPyramid::visit_cells(ProfileSearch&, std::size_t, std::size_t, std::size_t) const;

template <class Survey, class List>
void GridPyramid::list_cells(const Survey& survey, std::size_t column, std::size_t first_row, std::size_t last_row,
                             List& shortlist) const {
  for_each_triangle(survey, column, first_row, last_row,
                    [&](const FourTriangles& four, unsigned worth, const float* bounds, Index first) {
                      shortlist.add(four, worth, bounds, [&](unsigned lane) { return first + 2 * lane; });
                    });
}

template void GridPyramid::list_cells(const Survey&, std::size_t, std::size_t, std::size_t, Shortlist&) const;
template void GridPyramid::list_cells(const Survey&, std::size_t, std::size_t, std::size_t, LongList&) const;
template void GridPyramid::list_cells(const ProfileSurvey&, std::size_t, std::size_t, std::size_t, Shortlist&) const;
template void GridPyramid::list_cells(const ProfileSurvey&, std::size_t, std::size_t, std::size_t, LongList&) const;

Part GridPyramid::part(Index triangle) const {
  const Index columns = Index(columns_), s = triangle / 2, row = s / columns, column = s - row * columns;
  const bool upper = triangle % 2 == 1;
  const Shape& shape = shape_of(cell(column, row).falling, upper);
  const Index sample[4] = {s, s + 1, s + columns, s + columns + 1};
  const double x[2] = {t_.grid_x(column), t_.grid_x(column + 1)}, y[2] = {t_.grid_y(row), t_.grid_y(row + 1)};
  Part p;
  for (unsigned k = 0; k < 3; ++k) {
    const unsigned corner = shape.corner[k];
    p.corner[k] = {x[corner % 2], y[corner / 2], heights_[sample[corner]]};
    p.vertex[k] = 6 * sample[corner];
    p.edge[k] = 6 * sample[shape.edge_from[k]] + shape.edge_kind[k];
  }
  p.face = 6 * s + 4 + upper;
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
