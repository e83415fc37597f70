#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/cutter.hpp"
#include "krepl/error.hpp"
#include "krepl/terrain.hpp"
#include "krepl/tool_path.hpp"
#include "verify/zone_verifier.hpp"

namespace krepl::verify {

struct PathCheckOptions {
  double radius = 0;  ///< of the ball
  std::optional<Cutter> cutter;  ///< another tool than a ball, whose tip follows the path
  /// How far the ball's centre is above the points of the path.
  double lift = 0;
  double max_error = 0;  ///< what the path may cut into the part
  /// Number of places of the ball, spread evenly over the path; 0: as many as take some seconds. The ends and the
  /// middle of each move come on top.
  std::uint64_t samples = 0;
};

struct PathReport {
  double radius = 0, length = 0;
  double scale = 0;      ///< S of the accuracy contract: the largest of radius and extent
  double tolerance = 0;  ///< 1e-9 S, or 64 steps of the coordinates where that is coarser
  double step = 0;       ///< distance of places along the path
  std::size_t triangles = 0, moves = 0;
  std::vector<Check> checks;
  bool ok() const {
    for (const Check& c : checks)
      if (!c.ok()) return false;
    return true;
  }
};

/// Whether a ball that follows the path stays out of the part (and of everything below its upper side): at many places
/// of each move, ends and middle included, its centre's distance from all triangles and what is below them is R at
/// least. Of another cutter: no point of a triangle is inside of it. Arcs are followed on the circle. Between places the tool can be
/// deeper by half a step at most; so no move may lead farther away than 1000 S. `path` in the
/// part's coordinates. Errors: radius not finite and positive, no move, cancelled.
Result<PathReport> check_path(const ToolPath& path, const Terrain& part, const PathCheckOptions& options,
                              const Context& context = {});

}  // namespace krepl::verify
