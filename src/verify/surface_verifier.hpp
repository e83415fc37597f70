#pragma once

#include <cstdint>
#include <vector>

#include "input/subdivision_file.hpp"
#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/terrain.hpp"
#include "verify/zone_verifier.hpp"

namespace krepl::verify {

struct SurfaceCheckOptions {
  double radius = 0;
  /// Number of places at which the ball is let down; 0: as many as take some seconds.
  std::uint64_t samples = 0;
  std::uint64_t seed = 1;
};

struct SurfaceReport {
  double radius = 0;
  double scale = 0;      ///< S of the accuracy contract: the largest of radius and extent
  double tolerance = 0;  ///< 1e-9 S, or 64 steps of the coordinates where that is coarser
  double area = 0;       ///< of the projection: all faces that have a feature
  std::size_t triangles = 0, vertices = 0, edges = 0, faces = 0, holes = 0, components = 0;
  std::vector<Check> checks;
  bool ok() const {
    for (const Check& c : checks)
      if (!c.ok()) return false;
    return true;
  }
};

/// Checks the surface of terrain (+) ball against the terrain by brute force; see docs/verification.md for what each
/// check proves. If the topology itself is broken, the other checks are left out. Errors: radius not finite and
/// positive, cancelled.
Result<SurfaceReport> check_surface(input::SubdivisionFile file, const Terrain& terrain,
                                    const SurfaceCheckOptions& options, const Context& context = {});

}  // namespace krepl::verify
