#pragma once

#include <cstddef>

#include "krepl/surface.hpp"

namespace krepl::terrain {

/// How much there is of a surface, by kind. Face 0 and holes are among `faces` and of no kind.
struct SurfaceCounts {
  std::size_t vertices = 0, edges = 0, faces = 0;
  std::size_t seams = 0, valleys = 0, rims = 0;
  std::size_t planes = 0, cylinders = 0, spheres = 0;
  /// Vertices in which three valleys or more end: the ball touches three places at once.
  std::size_t triple_contacts = 0;
};

/// Linear time.
SurfaceCounts count_surface(const Surface& surface);

}  // namespace krepl::terrain
