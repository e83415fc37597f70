#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "free/shadow.hpp"
#include "kernel/packed_tree.hpp"
#include "krepl/context.hpp"
#include "model/terrain_access.hpp"

namespace krepl::free {

/// A rectangle and everything below its height.
struct ShadowBox {
  double min_x = std::numeric_limits<double>::infinity(), min_y = min_x, max_x = -min_x, max_y = -min_x, top = -min_x;

  void add(Point3 p) {
    min_x = std::min(min_x, p.x), max_x = std::max(max_x, p.x);
    min_y = std::min(min_y, p.y), max_y = std::max(max_y, p.y), top = std::max(top, p.z);
  }
  void add(const ShadowBox& b) {
    min_x = std::min(min_x, b.min_x), max_x = std::max(max_x, b.max_x);
    min_y = std::min(min_y, b.min_y), max_y = std::max(max_y, b.max_y), top = std::max(top, b.top);
  }
  /// Its nearest point, seen from a place.
  Vector<double> nearest(Point3 c) const {
    return {std::clamp(c.x, min_x, max_x) - c.x, std::clamp(c.y, min_y, max_y) - c.y, std::min(top - c.z, 0.0)};
  }
  bool covers(Point3 c) const { return min_x <= c.x && c.x <= max_x && min_y <= c.y && c.y <= max_y; }
};
inline double length(Vector<double> a) { return std::hypot(a.x, a.y, a.z); }

/// A triangle of a terrain with the numbers of its features; edge k runs from corner k to the next.
struct Part {
  std::array<Point3, 3> corner;
  std::array<Terrain::Index, 3> vertex, edge;
  Terrain::Index face = Terrain::none;
  bool vertical = false;
};

/// The triangles of a terrain in blocks of neighbours, and a tree over the boxes of these. Coordinates are relative to
/// the terrain's origin.
class TerrainShadows {
 public:
  TerrainShadows(const Terrain& terrain, const Context& context);

  const kernel::PackedTree<ShadowBox>& tree() const { return tree_; }

  /// Calls visit(part) for each triangle of a block of the tree.
  template <class Visit>
  void for_each(std::size_t block, const Visit& visit) const {
    if (!terrain_.is_grid()) {
      const std::size_t first = block * triangles_per_block;
      const std::size_t last = std::min(first + triangles_per_block, access_.triangles().size());
      for (std::size_t t = first; t < last; ++t) visit(mesh_part(t));
      return;
    }
    const auto& grid = terrain_.grid();
    const std::size_t column = block_[block].column * block_side, row = block_[block].row * block_side;
    for (std::size_t r = row; r < std::min(row + block_side, grid.rows - 1); ++r)
      for (std::size_t c = column; c < std::min(column + block_side, grid.columns - 1); ++c) {
        const TerrainAccess::Cell cell = access_.cell(c, r);
        if (cell.lower) visit(grid_part(c, r, cell.falling, false));
        if (cell.upper) visit(grid_part(c, r, cell.falling, true));
      }
  }

 private:
  static constexpr std::size_t triangles_per_block = 8, block_side = 4;
  struct Block {
    std::uint32_t column, row;
  };
  static std::vector<Block> blocks_of(const Terrain& terrain);
  std::vector<ShadowBox> boxes(const Context& context) const;
  Part mesh_part(std::size_t triangle) const;
  Part grid_part(std::size_t column, std::size_t row, bool falling, bool upper) const;

  const Terrain& terrain_;
  TerrainAccess access_;
  Terrain::Index first_edge_ = 0, first_triangle_ = 0;  // meshes
  std::vector<Block> block_;                            // grids
  kernel::PackedTree<ShadowBox> tree_;
};

}  // namespace krepl::free
