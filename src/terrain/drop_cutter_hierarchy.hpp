#pragma once

#include <optional>

#include "krepl/drop_cutter.hpp"
#include "terrain/drop_cutter_grid.hpp"
#include "terrain/drop_cutter_mesh.hpp"
#include "terrain/drop_cutter_settle.hpp"

namespace krepl {

/// A terrain as the cutter searches it: what does not depend on the radius.
class DropCutter::Hierarchy {
 public:
  Hierarchy(const Terrain& terrain, const Context& context) : terrain_(terrain), scale_(terrain) {
    if (terrain.is_grid()) grid_.emplace(terrain, scale_, context);
    else mesh_.emplace(terrain, scale_, context);
  }

  double extent() const { return scale_.extent; }
  /// About how far apart samples or vertices are.
  double cell() const { return grid_ ? grid_->cell() : mesh_->cell(); }

  /// Calls work(tree) with the GridPyramid or the MeshTree.
  template <class Work>
  auto with_tree(Work&& work) const {
    return grid_ ? work(*grid_) : work(*mesh_);
  }

  /// Where the tool was, what it touched, and by which triangle of the hierarchy.
  struct Trace {
    Point place;
    Contact contact;
    Index triangle = Terrain::none;
  };
  /// A triangle that the tool may well touch at a place near the trace's, or none.
  Index guess(const drop::GridPyramid& grid, const Trace& trace, Point place) const {
    if (trace.triangle == Terrain::none) return grid.triangle_at(place);
    if (terrain_.feature_kind(trace.contact.feature) != Terrain::FeatureKind::face) return trace.triangle;
    // The touched point of a plane moves along with the tool.
    const Point3 p = trace.contact.point;
    return grid.triangle_at({p.x + place.x - trace.place.x, p.y + place.y - trace.place.y});
  }
  Index guess(const drop::MeshTree&, const Trace& trace, Point) const { return trace.triangle; }

  /// Begins a search with the guess. After a jump of more than R what was touched says nothing.
  template <class Tree, class Tool>
  drop::ToolSearch<Tool> begin(const Tree& tree, const Tool& tool, const Trace& trace) const {
    drop::ToolSearch<Tool> search = tree.search(tool);
    const double x = tool.place.x - trace.place.x, y = tool.place.y - trace.place.y;
    const Index first = guess(tree, x * x + y * y < tool.squared ? trace : Trace{}, tool.place);
    if (first != Terrain::none) {
      tree.touch(search, first);
      search.skip = first;
    }
    return search;
  }
  template <class Tool>
  static Tool over(Point place, Tool tool) {
    tool.place = place;
    return tool;
  }
  /// Ends a search: the contact, and the trace for the next place.
  template <class Tree, class Search>
  Contact end(const Tree& tree, const Search& search, Trace& trace) const {
    Contact contact;
    if (search.feature() != Terrain::none) contact = drop::settle(search, tree.part(search.part()), scale_.extent);
    trace = {search.tool.place, contact, search.part()};
    return contact;
  }
  template <class Tree, class Tool>
  Contact touch(const Tree& tree, const Tool& tool, Trace& trace) const {
    if (!std::isfinite(tool.place.x) || !std::isfinite(tool.place.y)) return {};
    auto search = begin(tree, tool, trace);
    tree.run(search);
    return end(tree, search, trace);
  }
  /// A ball, whatever the cutter is.
  template <class Tree>
  Contact touch(const Tree& tree, Point place, double radius, Trace& trace) const {
    return touch(tree, drop::ball_over(place, radius), trace);
  }

 private:
  const Terrain& terrain_;
  drop::Scale scale_;
  std::optional<drop::GridPyramid> grid_;
  std::optional<drop::MeshTree> mesh_;
};

template <class Work>
auto DropCutter::with_tools(const Work& work) const {
  return hierarchy_->with_tree([&](const auto& tree) {
    if (cutter_.kind() == Cutter::Kind::ball) return work(tree, drop::ball_over({}, cutter_.radius()));
    return work(tree, drop::ProfileTool(cutter_));
  });
}

}  // namespace krepl
