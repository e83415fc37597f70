#pragma once

#include <cstdint>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/surface.hpp"

namespace krepl::output {

/// The edges of a surface as chords within a tolerance, the same for both faces of each edge.
class SurfaceEdges {
 public:
  using Index = Surface::Index;

  /// Errors: cancelled.
  static Result<SurfaceEdges> make(const Surface& surface, double max_error, const Context& context);

  /// Points between the ends of edge e, along half-edge 2e; at a rim those of the upper patch.
  const std::vector<Point3>& inner(Index e) const { return inner_[e]; }
  /// The largest distance between a chord and its curve.
  double deviation() const { return deviation_; }
  /// Takes these edges so much finer.
  Status refine(const Surface& surface, const std::vector<Index>& edges, double max_error, const Context& context);

  /// True if the face of half-edge h is the lower one of a rim: its border is the wall's foot.
  static bool is_foot(const Surface& surface, Index h) {
    const Surface::Edge edge = surface.edge(Subdivision::edge(h));
    return edge.kind == Surface::EdgeKind::rim && edge.feature[h & 1u] == Surface::none;
  }
  /// True if the surface goes on below the rim e.
  static bool has_foot(const Surface& surface, Index e) {
    for (const Index h : {2 * e, 2 * e + 1})
      if (is_foot(surface, h) && surface.face_feature(surface.subdivision().face[h]) != Surface::none) return true;
    return false;
  }

 private:
  std::vector<std::vector<Point3>> inner_;
  double deviation_ = 0;
};

}  // namespace krepl::output
