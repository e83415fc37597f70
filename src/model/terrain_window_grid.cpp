// Windows on grids: a word of marks a sample says what is in the window, then numbers follow the order of samples.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/terrain_window.hpp"

namespace krepl {
namespace {

using Index = Terrain::Index;

// Marks of a sample: as a vertex, its three edges, and the two triangles of the cell of which it is the least corner.
constexpr unsigned vertex_in = 1, vertex_core = 2, cell_is_falling = 256;
constexpr unsigned edge_in(unsigned kind) { return 4u << kind; }
constexpr unsigned edge_core(unsigned kind) { return 32u << kind; }
constexpr unsigned face_in(unsigned upper) { return 512u << upper; }

/// The cells [first, last] of which the interval [place(cell), place(cell + 1)] meets [low, high]; none if first >
/// last.
struct Interval {
  std::ptrdiff_t first, last;
  bool holds(std::size_t i) const { return first <= std::ptrdiff_t(i) && std::ptrdiff_t(i) <= last; }
};

template <class Place>
Interval cells_meeting(double low, double high, double size, std::size_t samples, const Place& place) {
  const std::ptrdiff_t most = std::ptrdiff_t(samples) - 2;
  const auto guess = [&](double v) {
    return std::ptrdiff_t(std::clamp(std::floor((v - place(0)) / size), 0.0, double(most)));
  };
  const auto at = [&](std::ptrdiff_t i) { return place(std::size_t(i)); };
  Interval cells{guess(low), guess(high)};
  // The guess is rounded; what counts are the places themselves.
  while (cells.first > 0 && at(cells.first) >= low) --cells.first;
  while (cells.first <= most && at(cells.first + 1) < low) ++cells.first;
  while (cells.last < most && at(cells.last + 1) <= high) ++cells.last;
  while (cells.last >= 0 && at(cells.last) > high) --cells.last;
  return cells;
}

/// A triangle by the window's own numbers of samples, in the order of TerrainWindow::Face. An edge is named by the
/// sample that its feature number has, and by its kind: 0 to +x, 1 to +y, 2 diagonal.
struct GridTriangle {
  std::array<Index, 3> sample;
  std::array<Index, 3> edge_sample;
  std::array<unsigned, 3> edge_kind;
};

GridTriangle grid_triangle(Index s, Index columns, bool falling, bool upper) {
  const Index east = s + 1, north = s + columns, far = north + 1;
  if (falling && upper) return {{east, far, north}, {east, north, s}, {1, 0, 2}};
  if (falling) return {{s, east, north}, {s, s, s}, {0, 2, 1}};
  if (upper) return {{s, far, north}, {s, north, s}, {2, 0, 1}};
  return {{s, east, far}, {s, east, s}, {0, 1, 2}};
}

}  // namespace

class TerrainWindow::GridFill {
 public:
  GridFill(TerrainWindow& window, const Terrain& terrain, Interval core_columns, Interval core_rows)
      : w_(window), t_(terrain), core_columns_(core_columns), core_rows_(core_rows) {
    const Terrain::Grid& grid = terrain.grid();
    column_ = std::size_t(std::max<std::ptrdiff_t>(0, core_columns.first - 1));
    row_ = std::size_t(std::max<std::ptrdiff_t>(0, core_rows.first - 1));
    columns_ = std::min(grid.columns, std::size_t(core_columns.last + 3)) - column_;
    rows_ = std::min(grid.rows, std::size_t(core_rows.last + 3)) - row_;
  }

  void run() {
    w_.mark_.assign(columns_ * rows_, 0);
    mark_core();
    mark_around();
    number_vertices();
    number_edges();
    add_faces();
  }

 private:
  bool core_cell(std::size_t c, std::size_t r) const {
    return core_columns_.holds(column_ + c) && core_rows_.holds(row_ + r);
  }
  Index feature(std::size_t c, std::size_t r, unsigned k) const {
    return Index(6 * ((row_ + r) * t_.grid().columns + column_ + c) + k);
  }
  GridTriangle triangle(std::size_t s, bool falling, bool upper) const {
    return grid_triangle(Index(s), Index(columns_), falling, upper);
  }

  void mark(std::size_t s, bool falling, bool upper, bool core) {
    const GridTriangle triangle_here = triangle(s, falling, upper);
    for (std::size_t i = 0; i < 3; ++i) {
      const unsigned kind = triangle_here.edge_kind[i];
      w_.mark_[triangle_here.sample[i]] |= std::uint16_t(vertex_in | (core ? vertex_core : 0u));
      w_.mark_[triangle_here.edge_sample[i]] |= std::uint16_t(edge_in(kind) | (core ? edge_core(kind) : 0u));
    }
    w_.mark_[s] |= std::uint16_t(face_in(upper) | (falling ? cell_is_falling : 0u));
  }

  void mark_core() {
    for (std::size_t r = 0; r + 1 < rows_; ++r)
      for (std::size_t c = 0; c + 1 < columns_; ++c) {
        if (!core_cell(c, r)) continue;
        const Terrain::Cell cell = t_.cell(column_ + c, row_ + r);
        if (cell.lower) mark(r * columns_ + c, cell.falling, false, true);
        if (cell.upper) mark(r * columns_ + c, cell.falling, true, true);
      }
  }

  /// Triangles of the cells around the core, if they have a core vertex.
  void mark_around() {
    for (std::size_t r = 0; r + 1 < rows_; ++r)
      for (std::size_t c = 0; c + 1 < columns_; ++c) {
        if (core_cell(c, r)) continue;
        const Terrain::Cell cell = t_.cell(column_ + c, row_ + r);
        for (const bool upper : {false, true}) {
          if (!(upper ? cell.upper : cell.lower)) continue;
          const std::size_t s = r * columns_ + c;
          for (const Index corner : triangle(s, cell.falling, upper).sample) {
            if ((w_.mark_[corner] & vertex_core) == 0) continue;
            mark(s, cell.falling, upper, false);
            break;
          }
        }
      }
  }

  void number_vertices() {
    w_.vertex_number_.resize(columns_ * rows_);
    for (std::size_t r = 0, s = 0; r < rows_; ++r)
      for (std::size_t c = 0; c < columns_; ++c, ++s) {
        if ((w_.mark_[s] & vertex_in) == 0) continue;
        w_.vertex_number_[s] = Index(w_.vertices_.size());
        const std::size_t sample = (row_ + r) * t_.grid().columns + column_ + c;
        w_.vertices_.push_back({{t_.grid_x(column_ + c), t_.grid_y(row_ + r), t_.height_[sample]},
                                feature(c, r, 0),
                                (w_.mark_[s] & vertex_core) != 0});
      }
  }

  void number_edges() {
    w_.edge_number_.resize(3 * columns_ * rows_);
    for (std::size_t r = 0, s = 0; r < rows_; ++r)
      for (std::size_t c = 0; c < columns_; ++c, ++s)
        for (unsigned kind = 0; kind < 3; ++kind) {
          if ((w_.mark_[s] & edge_in(kind)) == 0) continue;
          w_.edge_number_[3 * s + kind] = Index(w_.edges_.size());
          const bool falling_diagonal = kind == 2 && (w_.mark_[s] & cell_is_falling) != 0;
          const std::size_t from = falling_diagonal ? s + 1 : s;
          const std::size_t to = kind == 0 ? s + 1 : kind == 1 || falling_diagonal ? s + columns_ : s + columns_ + 1;
          w_.edges_.push_back({w_.vertex_number_[from], w_.vertex_number_[to], feature(c, r, 1 + kind),
                               (w_.mark_[s] & edge_core(kind)) != 0});
        }
  }

  void add_faces() {
    for (std::size_t r = 0, s = 0; r < rows_; ++r)
      for (std::size_t c = 0; c < columns_; ++c, ++s)
        for (const bool upper : {false, true}) {
          if ((w_.mark_[s] & face_in(upper)) == 0) continue;
          const GridTriangle here = triangle(s, (w_.mark_[s] & cell_is_falling) != 0, upper);
          Face face{{}, {}, feature(c, r, upper ? 5 : 4), false, core_cell(c, r)};
          for (std::size_t i = 0; i < 3; ++i) {
            face.vertex[i] = w_.vertex_number_[here.sample[i]];
            face.edge[i] = w_.edge_number_[3 * here.edge_sample[i] + here.edge_kind[i]];
          }
          w_.faces_.push_back(face);
        }
  }

  TerrainWindow& w_;
  const Terrain& t_;
  Interval core_columns_, core_rows_;
  std::size_t column_, row_;    // the first sample of the window
  std::size_t columns_, rows_;  // its samples
};

void TerrainWindow::fill_grid(const Terrain& terrain, Point low, Point high) {
  if (!(low.x <= high.x) || !(low.y <= high.y)) return;
  const Terrain::Grid& grid = terrain.grid();
  const Interval columns =
      cells_meeting(low.x, high.x, grid.cell_x, grid.columns, [&](std::size_t c) { return terrain.grid_x(c); });
  const Interval rows =
      cells_meeting(low.y, high.y, grid.cell_y, grid.rows, [&](std::size_t r) { return terrain.grid_y(r); });
  if (columns.first > columns.last || rows.first > rows.last) return;
  GridFill(*this, terrain, columns, rows).run();
}

}  // namespace krepl
