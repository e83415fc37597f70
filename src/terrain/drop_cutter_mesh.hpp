#pragma once

#include <cstddef>
#include <vector>

#include "krepl/context.hpp"
#include "model/terrain_access.hpp"
#include "terrain/drop_cutter_search.hpp"

namespace krepl::drop {

/// A packed tree, eight children a node, over the triangles of a mesh in their order, which follows the plane. Every box has
/// its highest point and a plane above its content. 37 bytes a triangle, and one for which of its features it owns.
class MeshTree {
 public:
  MeshTree(const Terrain& terrain, const Scale& scale, const Context& context);

  Search search(Point place, double radius) const;
  /// Looks at all that may be touched. `first`: the triangle to look at first, or none.
  void run(Search& search, Index first) const;

  Index feature_of_vertex(Index v) const { return v; }
  Index feature_of_edge(Index e) const { return first_edge_ + e; }
  Index feature_of_triangle(Index t) const { return first_triangle_ + t; }
  Index triangle_of_feature(Index feature) const { return feature - first_triangle_; }
  const TerrainAccess& terrain() const { return t_; }

 private:
  static constexpr std::size_t arity = 8;
  struct alignas(64) Node {
    float x0[arity], y0[arity], x1[arity], y1[arity], top[arity], level[arity], slope_x[arity], slope_y[arity];
  };

  std::array<Point3, 3> corners(std::size_t triangle) const;
  void build_level(std::size_t level, const Context& context);
  void bound_box(std::size_t level, std::size_t first, std::size_t last, Node& node, std::size_t child) const;
  void choose_owners();

  template <class Found>
  void add_children(const Search& search, std::size_t level, std::size_t index, Found& found) const;
  void visit(Search& search, std::size_t level, std::size_t index) const;
  void touch_triangle(Search& search, Index triangle) const;

  TerrainAccess t_;
  Scale scale_;
  Index first_edge_, first_triangle_;
  std::vector<std::vector<Node>> levels_;  // levels_[0]: of triangles; the last one is one node
  std::vector<std::uint8_t> owned_;        // bits 0-2: edges, 3-5: vertices
};

}  // namespace krepl::drop
