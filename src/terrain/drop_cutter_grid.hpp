#pragma once

#include <cstddef>
#include <vector>

#include "krepl/context.hpp"
#include "model/terrain_access.hpp"
#include "terrain/drop_cutter_search.hpp"
#include "terrain/drop_cutter_shortlist.hpp"

namespace krepl::drop {

/// A pyramid of blocks over a grid: 4 x 4 cells, 4 x 4 of those, and so on, each with its highest sample and a plane above
/// its samples. 16 bytes a block; cells themselves are bounded from their samples when they are needed.
///
/// A cell here is named by its sample with least x and y, its triangles by 2 * sample for the one below the diagonal and one
/// more for the one above.
class GridPyramid {
 public:
  GridPyramid(const Terrain& terrain, const Scale& scale, const Context& context);

  template <class Tool>
  ToolSearch<Tool> search(const Tool& tool) const {
    return {scale_, tool, moved(tool.place, tool.radius)};
  }
  /// `tool` over the middle of the rectangle of places.
  template <class Tool>
  ToolSurvey<Tool> survey(const Tool& tool, const ManyPlaces& spread) const {
    return {scale_, tool, moved(tool.place, tool.radius), spread};
  }
  double inverse_unit() const { return scale_.inverse_unit; }
  double cell() const { return std::sqrt(grid_.cell_x * grid_.cell_y); }

  /// Looks at all triangles that may be touched. Searches are those of balls and of other cutters.
  template <class Search>
  void run(Search& search) const;
  /// Lists all triangles that may be touched over some place of the survey, of a ball or another cutter.
  template <class Survey, class List>
  void list(const Survey& survey, List& list) const;
  /// Looks at one triangle.
  template <class Search>
  void touch(Search& search, Index triangle) const {
    if (triangle != search.skip) search.touch(part(triangle), triangle);
  }
  /// The triangle below a point, or none.
  Index triangle_at(Point p) const;
  /// Precondition: the triangle is there.
  Part part(Index triangle) const;

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

  TerrainAccess::Cell cell(std::size_t column, std::size_t row) const {
    if (complete_ && grid_.split == Terrain::Split::rising) [[likely]] return {false, true, true};
    return t_.cell(column, row);
  }
  void build_level(std::size_t level, const Context& context);
  void bound_block(std::size_t level, std::size_t column, std::size_t row, Node& node, std::size_t child) const;

  Moved moved(Point place, double radius) const;
  template <class Query>
  bool reach(const Query& query, double margin_x, double margin_y, Reach& reach) const;
  /// Calls visit(level, column, row) for the nodes that hold all cells of a reach: four at most if there are enough levels.
  template <class Visit>
  void start(const Reach& reach, const Visit& visit) const;
  static bool is_small(const Reach& reach);
  /// Bounds of the blocks of a node, row by row; returns which are worth a look, as bits.
  template <class Query>
  unsigned bound_children(const Query& query, const Reach& reach, std::size_t level, std::size_t column,
                          std::size_t row, float* bounds) const;
  template <class Search, std::size_t capacity>
  void add_children(const Search& search, const Reach& reach, std::size_t level, std::size_t column, std::size_t row,
                    Candidates<capacity>& found) const;
  template <class Search, std::size_t capacity>
  void visit(Search& search, const Reach& reach, std::size_t level, const Candidates<capacity>& found) const;
  template <class Survey, class List>
  void list_node(const Survey& survey, const Reach& reach, std::size_t level, std::size_t column, std::size_t row,
                 List& shortlist) const;

  // Cells, four a row, from first_row to last_row (8 rows at most).
  struct FourCells;
  FourBlocks blocks(const FourCells& cells) const;
  FourTriangles triangles(const FourCells& cells, bool upper) const;
  Float4 falling(std::size_t column, std::size_t row) const;
  void load(std::size_t column, std::size_t row, Float4& here, Float4& east) const;
  template <class Query, class Each>
  void for_each_triangle(const Query& query, std::size_t column, std::size_t first_row, std::size_t last_row,
                         const Each& each) const;
  template <class Search>
  void visit_cells(Search& search, std::size_t column, std::size_t first_row, std::size_t last_row) const;
  template <class Survey, class List>
  void list_cells(const Survey& survey, std::size_t column, std::size_t first_row, std::size_t last_row,
                  List& shortlist) const;

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
