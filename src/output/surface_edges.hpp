#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/surface.hpp"

namespace krepl::output {

/// The edges of a surface as chords within a tolerance, the same for both faces of each edge. Refers to the surface.
class SurfaceEdges {
 public:
  using Index = Surface::Index;

  /// Errors: 2^32 points or more; cancelled.
  static Result<SurfaceEdges> make(const Surface& surface, double max_error, const Context& context);

  /// Points between the ends of edge e, along half-edge 2e; at a rim those of the upper patch.
  std::span<const Point3> inner(Index e) const;
  /// At a rim above a lower part, the same at the wall's foot; else none.
  std::span<const Point3> foot(Index e) const { return points_of(e).subspan(inner(e).size()); }

  /// All points are numbered: edge by edge, the inner ones before the foot.
  Index first(Index e) const { return first_[e / block_size] + block_[e / block_size].begin[e % block_size]; }
  Index count() const { return first_.back(); }
  Point3 point(Index i) const;

  /// The largest distance between a chord and its curve.
  double deviation() const { return deviation_; }
  /// Takes these edges, ascending, so much finer. Errors as of make().
  Status refine(std::span<const Index> edges, double max_error, const Context& context);

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
  static constexpr Index block_size = 256;
  /// Points of consecutive edges. One array of all would be there twice while it grows, and whenever edges are refined.
  struct Block {
    std::vector<Index> begin;  // per edge and one more
    std::vector<Point3> points;
  };

  explicit SurfaceEdges(const Surface& surface) : surface_(&surface) {}
  std::span<const Point3> points_of(Index e) const;
  double remake(std::span<const Index> edges, double max_error);
  Status number();

  const Surface* surface_;
  std::vector<Block> block_;
  std::vector<Index> first_;  // per block and one more: the number of its first point
  double deviation_ = 0;
};

}  // namespace krepl::output
