#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "verify/surface_checks.hpp"

namespace krepl::verify {

/// Finds edges of a surface in the plane, by their chords. The true curve of an edge is within its sag of them.
class EdgeMap {
 public:
  using Index = SurfaceCase::Index;

  explicit EdgeMap(const SurfaceCase& surface);

  /// The face above which (x, y) lies: the one below the first edge that a ray towards +y meets. Several faces if
  /// chords do not tell: both sides of each edge whose sag reaches the place, and those below edges that the ray meets
  /// next to each other. Edges of component `without` are passed over.
  void locate(double x, double y, std::vector<Index>& faces, Index without = SurfaceCase::none) const;

  /// Distance in the plane from (x, y) to the nearest chord of an edge for which wanted(edge); `limit` if there is none
  /// nearer.
  template <class Wanted>
  double distance(double x, double y, double limit, Wanted&& wanted) const;

  Box3 box_of(Index edge) const;
  const BoxHierarchy& tree() const { return tree_; }

 private:
  const SurfaceCase& surface_;
  BoxHierarchy tree_;
};

/// Distance in the plane from (x, y) to the segment a b.
double plane_distance(double x, double y, Space<double> a, Space<double> b);

template <class Wanted>
double EdgeMap::distance(double x, double y, double limit, Wanted&& wanted) const {
  double best = limit;
  const auto key = [&](const Box3& b) { return std::sqrt(b.square_distance(x, y)); };
  tree_.search(
      key, [&] { return best; },
      [&](Index e) {
        if (!wanted(e)) return;
        for (std::uint64_t i = surface_.file.edges[e].first + 1; i < surface_.file.points_end(e); ++i)
          best = std::min(best, plane_distance(x, y, surface_.point(i - 1), surface_.point(i)));
      });
  return best;
}

}  // namespace krepl::verify
