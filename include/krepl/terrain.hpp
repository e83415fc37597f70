#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/point.hpp"

namespace krepl {

/// A terrain or part seen from above: a set of triangles of which the upper side counts, everything below them being solid.
///
/// Two kinds share one interface. A *grid* has samples at equal distances and stays implicit: each cell of four samples is two
/// triangles, and a triangle with a missing sample is left out. A *mesh* is any set of triangles: open, closed,
/// overhanging, with vertical walls, several parts, edges of more than two triangles.
///
/// Features are what a ball can touch: faces (triangles that are not vertical), edges and vertices. Each has a number that is
/// fixed by the input alone. Coordinates are relative to origin(), which is taken off exactly.
class Terrain {
 public:
  using Index = std::uint32_t;
  static constexpr Index none = ~Index{0};

  enum class FeatureKind : std::uint8_t { vertex, edge, face };

  /// Which diagonal splits a cell of a grid.
  enum class Split : std::uint8_t {
    rising,   ///< from its (min x, min y) to its (max x, max y) corner (the default)
    falling,  ///< the other one
    shorter   ///< the one between the two samples that differ less in height; rising if both do alike, and where one of
              ///< the two lacks a sample, the other one
  };

  struct Grid {
    std::size_t columns = 0, rows = 0;  ///< samples, 2 or more each
    Point first;                        ///< place of sample (0, 0), the one with the least x and y
    double cell_x = 1, cell_y = 1;      ///< distance of neighbouring samples, positive
    Split split = Split::rising;
  };

  /// What was found and left out on the way in.
  struct Report {
    std::size_t triangles = 0;             ///< given
    std::size_t zero_area_triangles = 0;   ///< dropped
    std::size_t repeated_triangles = 0;    ///< dropped: same three vertices as an earlier one
    std::size_t welded_vertices = 0;       ///< vertices that coincide with an earlier one
    std::size_t missing_samples = 0;       ///< grid samples without data
    std::size_t vertical_triangles = 0;    ///< kept: their edges and vertices count, they have no upper side
    std::size_t border_edges = 0;          ///< edges of one triangle (meshes only)
    std::size_t non_manifold_edges = 0;    ///< edges of three or more triangles (meshes only)
  };

  /// `heights` has grid.columns * grid.rows values, row by row from least y, x ascending; NaN means no data.
  /// Errors: fewer than 2 x 2 samples; more than 2^29; a number of heights that is not columns * rows (usage); an infinite
  /// height (named by column and row); a place or cell size that is not finite, not positive or too fine for double
  /// precision; no triangle left; cancelled. Linear time; keeps 8 bytes a sample.
  static Result<Terrain> from_grid(const Grid& grid, std::vector<double> heights, const Context& context = {});

  /// Triangles by three indices into `vertices`, in any orientation. Coinciding vertices are welded.
  /// Triangles without area (exactly) and repeated ones are dropped, vertices that no triangle is left to use likewise.
  /// Features are numbered along a Hilbert curve of the plane, whatever order the triangles come in.
  ///
  /// Errors: NaN or infinite coordinates or an index out of range (the triangle is named, counted from 0); no triangle left;
  /// more than 2^29; cancelled. O(n log n), about half a microsecond a triangle; keeps some 70 bytes a triangle.
  static Result<Terrain> from_triangles(std::vector<Point3> vertices, std::vector<std::array<Index, 3>> triangles,
                                        const Context& context = {});

  bool is_grid() const { return is_grid_; }
  /// Meaningful if is_grid(); `first` is relative to origin().
  const Grid& grid() const { return grid_; }
  const Report& report() const { return report_; }
  /// What was subtracted from x, y and z of the input; the subtraction is exact.
  Point3 origin() const { return origin_; }
  /// Bounding box, relative to origin().
  Point3 lowest() const { return lowest_; }
  Point3 highest() const { return highest_; }
  /// Largest absolute coordinate, relative to origin().
  double extent() const;
  std::size_t triangle_count() const { return triangle_count_; }

  /// Feature numbers lie below this; those of a grid are not all in use.
  std::size_t feature_bound() const;
  FeatureKind feature_kind(Index feature) const;
  /// The feature's input points: 1, 2 or 3. Precondition: the feature is in use.
  struct Corners {
    std::array<Point3, 3> point;
    int count;
  };
  Corners corners(Index feature) const;

 private:
  friend class TerrainWindow;
  friend class TerrainAccess;
  friend class MeshBuilder;
  Terrain() = default;

  // Grids: which triangles of the cell with the given least sample exist, and by which diagonal it is split.
  struct Cell {
    bool falling, lower, upper;
  };
  Cell cell(std::size_t column, std::size_t row) const;
  double grid_x(std::size_t column) const { return grid_.first.x + double(column) * grid_.cell_x; }
  double grid_y(std::size_t row) const { return grid_.first.y + double(row) * grid_.cell_y; }
  Point3 grid_point(std::size_t sample) const {
    return {grid_x(sample % grid_.columns), grid_y(sample / grid_.columns), height_[sample]};
  }
  Status survey_grid(const Context& context);
  Corners grid_corners(Index feature) const;

  bool is_grid_ = false;
  Grid grid_;
  Report report_;
  Point3 origin_{}, lowest_{}, highest_{};
  std::size_t triangle_count_ = 0;

  std::vector<double> height_;  // grid

  // Mesh. Vertices along a Hilbert curve; edges by (lower, higher) vertex; triangles by their sorted vertices.
  std::vector<Point3> vertex_;
  struct Edge {
    Index a, b;
  };
  std::vector<Edge> edge_;
  struct Triangle {
    std::array<Index, 3> vertex;  // counter-clockwise from above, or ascending if vertical; the lowest number first
    std::array<Index, 3> edge;    // edge i runs between vertex i and vertex (i + 1) % 3
    bool vertical;
  };
  std::vector<Triangle> triangle_;
  // Compressed rows: the triangles around a vertex, ascending.
  std::vector<Index> vertex_triangle_begin_, vertex_triangle_;
  // Packed tree over the bounding rectangles of the triangles in their order, which follows the plane: level 0 has a box for
  // each tree_arity triangles, every further level one for as many boxes. The last level is one box.
  struct Box {
    double min_x, min_y, max_x, max_y;
  };
  static constexpr std::size_t tree_arity = 8;
  std::vector<std::vector<Box>> tree_;
};

}  // namespace krepl
