#pragma once

#include <cstddef>
#include <vector>

#include "krepl/point.hpp"

namespace krepl::lab {

/// A 2D terrain of section 2.3, the radius that belongs to it, and what its sum must have.
struct ProfileConstruction {
  const char* name;
  const char* what;
  std::vector<Point> terrain;
  double radius;
  std::size_t vertices, explicit_ones;
};

/// n segments of a strictly convex chain: each shows, and each of the n + 1 vertices shows its arc: 2n + 2 vertices,
/// the most there can be (theorem 2.3.4), none of them explicit.
ProfileConstruction convex_chain(std::size_t segments);
/// n segments of a bowl wider than the disk: two neighbours meet in an explicit vertex each, n - 1 in all, the most
/// there can be. Precondition: 1 segment or more, as for all.
ProfileConstruction bowl(std::size_t segments);
/// A pit of n segments that the disk does not enter: it rests on the two ends of the terrain only. 3 vertices, the
/// fewest that any terrain has whose ends are apart: each end has an arc of its own. Precondition: 2 segments or more.
ProfileConstruction pit(std::size_t segments);

}  // namespace krepl::lab
