#pragma once

#include <cstddef>
#include <vector>

#include "krepl/context.hpp"
#include "model/terrain_access.hpp"
#include "terrain/drop_cutter_search.hpp"

namespace krepl::drop {

/// A pyramid of blocks over a grid: 4 x 4 cells, 4 x 4 of those, and so on, each with its highest sample and a plane above
/// its samples. 16 bytes a block; cells themselves are bounded from their samples when they are needed.
///
/// A cell here is named by its sample with least x and y and owns that sample as a vertex, the edges from it to +x and +y,
/// its diagonal and its two triangles: whatever feature is the highest, its owner's samples bound it. Samples at the far sides
/// own what they have, so there are as many cells as samples.
class GridPyramid {
 public:
  GridPyramid(const Terrain& terrain, const Scale& scale, const Context& context);

  Search search(Point place, double radius) const;
  /// Looks at all that may be touched. `first`: the part to look at first, or none.
  void run(Search& search, Index first) const;
  /// The cell below a point, or none.
  Index part_at(Point p) const;

  Point3 point(std::size_t sample) const {
    return {t_.grid_x(sample % columns_), t_.grid_y(sample / columns_), height(sample)};
  }

 private:
  static constexpr std::size_t arity = 4;  // a side
  /// What is known of the 4 x 4 blocks that a larger block consists of, row by row.
  struct alignas(64) Node {
    float top[16], level[16], slope_x[16], slope_y[16];
  };
  struct Level {
    std::size_t columns = 0, rows = 0;
    std::vector<Node> nodes;
  };
  /// Cells that the ball may reach, first and last.
  struct Reach {
    std::size_t first_column, last_column, first_row, last_row;
  };

  double height(std::size_t sample) const { return heights_[sample]; }
  /// Of a cell without missing samples, given its first one: as Terrain::cell() has it.
  bool is_falling(const double* z) const {
    if (grid_.split != Terrain::Split::shorter) return grid_.split == Terrain::Split::falling;
    return std::abs(z[1] - z[columns_]) < std::abs(z[0] - z[columns_ + 1]);
  }
  void build_level(std::size_t level, const Context& context);
  void bound_block(std::size_t level, std::size_t column, std::size_t row, Node& node, std::size_t child) const;

  bool reach(const Search& search, Reach& reach) const;
  template <std::size_t capacity>
  void add_children(const Search& search, const Reach& reach, std::size_t level, std::size_t column, std::size_t row,
                    Candidates<capacity>& found) const;
  template <std::size_t capacity>
  void visit(Search& search, const Reach& reach, std::size_t level, const Candidates<capacity>& found) const;
  void visit_cells(Search& search, std::size_t column, std::size_t first_row, std::size_t last_row) const;
  void load(std::size_t column, std::size_t row, Float4& here, Float4& east) const;

  void touch_cell(Search& search, std::size_t column, std::size_t row) const;
  void touch_whole_cell(Search& search, std::size_t sample, std::size_t column, std::size_t row) const;
  void touch_border_cell(Search& search, std::size_t column, std::size_t row) const;
  bool has_triangle(std::size_t column, std::size_t row, unsigned with) const;
  bool in_use(std::size_t column, std::size_t row, Index k) const;

  TerrainAccess t_;
  const double* heights_;
  Terrain::Grid grid_;
  Scale scale_;
  std::size_t columns_, rows_;
  Point inverse_cell_;
  float width_, height_;       // of a cell, in the unit of the bounds
  bool complete_;              // no sample is missing
  std::vector<Level> levels_;  // levels_[0]: of blocks of 4 x 4 cells
};

}  // namespace krepl::drop
