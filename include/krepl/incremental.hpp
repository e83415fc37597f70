#pragma once

#include <cstddef>
#include <memory>

#include "krepl/surface.hpp"

namespace krepl {

struct IncrementalOptions {
  /// Radius of the ball in the unit of the terrain: finite and positive.
  double radius = 0;
  /// More triangles are refused: each union looks at all that is there.
  std::size_t most_triangles = 1000;
};

/// The exact surface of terrain (+) ball by the thesis's own way, section 4.5 (Mink3D, ComputeUnion): semi-kreplach in
/// monotone order, each united with all before it (docs/incremental.md). A witness for compute_surface, with which it
/// shares the model and the class of the result, and no algorithm. One thread. Counters say how many components the
/// intersections had.
///
/// Errors: radius not finite and positive, or below 2^-20 of the extent; more triangles than `most_triangles`;
/// cancelled; a union that could not be certified (the place and the step are named). Time at most cubic in the number
/// of triangles near each other.
Result<Surface> compute_surface_incremental(std::shared_ptr<const Terrain> terrain, const IncrementalOptions& options,
                                            const Context& context = {});

}  // namespace krepl
