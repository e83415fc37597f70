// The features of one cell of a grid, in the closed forms.
#include "terrain/drop_cutter_grid.hpp"

namespace krepl::drop {
namespace {

using Kind = Terrain::FeatureKind;

// Numbers of features within a cell, and its corners as bits; see terrain_grid.cpp.
enum : Index { vertex = 0, edge_east = 1, edge_north = 2, diagonal = 3, lower = 4, upper = 5 };
enum : unsigned { south_west = 1, south_east = 2, north_west = 4, north_east = 8 };

constexpr unsigned corners(bool falling, bool upper_one) {
  if (falling) return upper_one ? south_east | north_east | north_west : south_west | south_east | north_west;
  return upper_one ? south_west | north_east | north_west : south_west | south_east | north_east;
}

}  // namespace

void GridPyramid::touch_cell(Search& search, std::size_t column, std::size_t row) const {
  const std::size_t sample = row * columns_ + column;
  if (sample == search.skip) return;
  if (complete_ && column + 1 < columns_ && row + 1 < rows_) [[likely]] {
    touch_whole_cell(search, sample, column, row);
  } else {
    touch_border_cell(search, column, row);
  }
}

/// The triangles first: they say which of their sides are worth a look.
void GridPyramid::touch_whole_cell(Search& search, std::size_t sample, std::size_t column, std::size_t row) const {
  const double x0 = t_.grid_x(column), x1 = t_.grid_x(column + 1), y0 = t_.grid_y(row), y1 = t_.grid_y(row + 1);
  const double* z = heights_ + sample;
  const Point3 sw{x0, y0, z[0]}, se{x1, y0, z[1]}, nw{x0, y1, z[columns_]}, ne{x1, y1, z[columns_ + 1]};
  const Index part = Index(sample), feature = 6 * part;
  const auto offer = [&](double height, Index k, Kind kind) {
    if (search.wants(height, feature + k, kind)) search.take(height, feature + k, kind, part);
  };
  const bool falling = is_falling(z);
  const FaceTouch below = falling ? touch_face(sw, se, nw, search.ball) : touch_face(sw, se, ne, search.ball);
  const FaceTouch above = falling ? touch_face(se, ne, nw, search.ball) : touch_face(sw, ne, nw, search.ball);
  offer(below.height, lower, Kind::face);
  offer(above.height, upper, Kind::face);
  const bool east = below.beyond & 1, north = (falling ? below : above).beyond & 4;
  const bool across = falling ? (below.beyond & 2) && (above.beyond & 4) : (below.beyond & 4) && (above.beyond & 1);
  if (east) offer(touch_edge(sw, se, search.ball).height, edge_east, Kind::edge);
  if (north) offer(touch_edge(sw, nw, search.ball).height, edge_north, Kind::edge);
  if (across) offer(touch_edge(falling ? se : sw, falling ? nw : ne, search.ball).height, diagonal, Kind::edge);
  if ((below.beyond & 5) && (falling || (above.beyond & 5))) offer(touch_vertex(sw, search.ball).height, vertex, Kind::vertex);
}

/// True if a triangle of the cell exists that has all the given corners.
bool GridPyramid::has_triangle(std::size_t column, std::size_t row, unsigned with) const {
  if (column >= columns_ - 1 || row >= rows_ - 1) return false;  // also where 1 was taken from 0
  const TerrainAccess::Cell cell = t_.cell(column, row);
  return (cell.lower && (corners(cell.falling, false) & with) == with) ||
         (cell.upper && (corners(cell.falling, true) & with) == with);
}

/// A feature that is the highest so far may still not be there: edges and samples need a triangle.
bool GridPyramid::in_use(std::size_t i, std::size_t j, Index k) const {
  switch (k) {
    case vertex:
      return has_triangle(i, j, south_west) || has_triangle(i - 1, j, south_east) || has_triangle(i, j - 1, north_west) ||
             has_triangle(i - 1, j - 1, north_east);
    case edge_east: return has_triangle(i, j, south_west | south_east) || has_triangle(i, j - 1, north_west | north_east);
    case edge_north: return has_triangle(i, j, south_west | north_west) || has_triangle(i - 1, j, south_east | north_east);
    default: return true;
  }
}

void GridPyramid::touch_border_cell(Search& search, std::size_t column, std::size_t row) const {
  const std::size_t sample = row * columns_ + column;
  const Index part = Index(sample), feature = 6 * part;
  const auto offer = [&](double height, Index k, Kind kind) {
    if (search.wants(height, feature + k, kind) && in_use(column, row, k)) search.take(height, feature + k, kind, part);
  };
  // A missing sample makes the height NaN, which no search wants.
  const Point3 sw = point(sample);
  const bool has_east = column + 1 < columns_, has_north = row + 1 < rows_;
  offer(touch_vertex(sw, search.ball).height, vertex, Kind::vertex);
  if (has_east) offer(touch_edge(sw, point(sample + 1), search.ball).height, edge_east, Kind::edge);
  if (has_north) offer(touch_edge(sw, point(sample + columns_), search.ball).height, edge_north, Kind::edge);
  if (!has_east || !has_north) return;
  const TerrainAccess::Cell cell = t_.cell(column, row);
  const Point3 se = point(sample + 1), nw = point(sample + columns_), ne = point(sample + columns_ + 1);
  if (cell.lower || cell.upper) {
    offer(cell.falling ? touch_edge(se, nw, search.ball).height : touch_edge(sw, ne, search.ball).height, diagonal, Kind::edge);
  }
  if (cell.lower) offer(touch_face(sw, se, cell.falling ? nw : ne, search.ball).height, lower, Kind::face);
  if (cell.upper) offer(touch_face(cell.falling ? se : sw, ne, nw, search.ball).height, upper, Kind::face);
}

}  // namespace krepl::drop
