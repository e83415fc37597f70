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

  /// Where the ball was, what it touched, and by which triangle of the hierarchy.
  struct Trace {
    Point place;
    Contact contact;
    Index triangle = Terrain::none;
  };
  /// A triangle that the ball may well touch at a place near the trace's, or none.
  Index guess(const drop::GridPyramid& grid, const Trace& trace, Point place) const {
    if (trace.triangle == Terrain::none) return grid.triangle_at(place);
    if (terrain_.feature_kind(trace.contact.feature) != Terrain::FeatureKind::face) return trace.triangle;
    // The touched point of a plane moves along with the ball.
    const Point3 p = trace.contact.point;
    return grid.triangle_at({p.x + place.x - trace.place.x, p.y + place.y - trace.place.y});
  }
  Index guess(const drop::MeshTree&, const Trace& trace, Point) const { return trace.triangle; }

  /// Begins a search with the guess. After a jump of more than R what was touched says nothing.
  template <class Tree>
  drop::Search begin(const Tree& tree, Point place, double radius, const Trace& trace) const {
    drop::Search search = tree.search(place, radius);
    const double x = place.x - trace.place.x, y = place.y - trace.place.y;
    const Index first = guess(tree, x * x + y * y < search.ball.squared ? trace : Trace{}, place);
    if (first != Terrain::none) {
      tree.touch(search, first);
      search.skip = first;
    }
    return search;
  }
  /// Ends a search: the contact, and the trace for the next place.
  template <class Tree>
  Contact end(const Tree& tree, const drop::Search& search, Trace& trace) const {
    Contact contact;
    if (search.feature() != Terrain::none) contact = drop::settle(search, tree.part(search.part()), scale_.extent);
    trace = {search.ball.place, contact, search.part()};
    return contact;
  }
  template <class Tree>
  Contact touch(const Tree& tree, Point place, double radius, Trace& trace) const {
    if (!std::isfinite(place.x) || !std::isfinite(place.y)) return {};
    drop::Search search = begin(tree, place, radius, trace);
    tree.run(search);
    return end(tree, search, trace);
  }

 private:
  const Terrain& terrain_;
  drop::Scale scale_;
  std::optional<drop::GridPyramid> grid_;
  std::optional<drop::MeshTree> mesh_;
};

}  // namespace krepl
