#pragma once

#include <cstddef>
#include <vector>

#include "krepl/context.hpp"
#include "model/terrain_access.hpp"
#include "terrain/drop_cutter_search.hpp"
#include "terrain/drop_cutter_shortlist.hpp"

namespace krepl::drop {

/// A packed tree, eight children a node, over the triangles of a mesh in their order, which follows the plane. Every box has
/// its highest point and a plane above its content. 53 bytes a triangle.
class MeshTree {
 public:
  MeshTree(const Terrain& terrain, const Scale& scale, const Context& context);

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
  double cell() const { return cell_; }

  /// Looks at all triangles that may be touched. Searches are those of balls and of other cutters.
  template <class Search>
  void run(Search& search) const {
    visit(search, levels_.size(), 0);
  }
  /// Lists all triangles that may be touched over some place of the survey, of a ball or another cutter.
  template <class Survey, class List>
  void list(const Survey& survey, List& list) const;
  /// Looks at one triangle.
  template <class Search>
  void touch(Search& search, Index triangle) const {
    if (triangle != search.skip) search.touch(part(triangle), triangle);
  }
  Part part(Index triangle) const;

 private:
  static constexpr std::size_t arity = 8;
  struct alignas(64) Node {
    float x0[arity], y0[arity], x1[arity], y1[arity], top[arity], level[arity], slope_x[arity], slope_y[arity];
  };
  /// Triangles, their places relative to one of their corners.
  struct alignas(64) Leaf {
    Point origin;
    float top[arity], z[arity], slope_x[arity], slope_y[arity], x[3][arity], y[3][arity];
  };

  std::array<Point3, 3> corners(std::size_t triangle) const;
  void build_leaves(const Context& context);
  void put(const std::array<Point3, 3>& corner, double slack, Leaf& leaf, std::size_t child) const;
  static void put_nothing(Leaf& leaf, std::size_t child);
  void build_level(std::size_t level, const Context& context);
  void bound_box(std::size_t level, std::size_t first, std::size_t last, Node& node, std::size_t child) const;

  Moved moved(Point place, double radius) const;
  template <class Query>
  unsigned bound_children(const Query& query, const Node& node, float* bounds) const;
  FourTriangles triangles(Point place, const Leaf& leaf, std::size_t first) const;
  // Level 0 is that of the leaves, level k of levels_[k - 1].
  template <class Search>
  void visit(Search& search, std::size_t level, std::size_t index) const;
  template <class Survey, class List>
  void list_node(const Survey& survey, std::size_t level, std::size_t index, List& shortlist) const;

  TerrainAccess t_;
  Scale scale_;
  Index first_edge_, first_triangle_;
  double cell_;
  std::vector<Leaf> leaves_;
  std::vector<std::vector<Node>> levels_;  // levels_[0]: of leaves; the last one is one node
};

}  // namespace krepl::drop
