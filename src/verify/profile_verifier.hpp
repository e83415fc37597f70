#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "input/profile_reader.hpp"
#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/point.hpp"
#include "verify/zone_verifier.hpp"

namespace krepl::verify {

struct ProfileCheckOptions {
  double radius = 0;
  /// Samples on each piece between its ends, random but for the middle; at least 1.
  int samples_per_piece = 3;
  /// Number of places at which the height is compared with a brute-force envelope; 0: as many as points, 1e6 at most.
  std::uint64_t heights = 0;
  std::uint64_t seed = 1;
};

struct ProfileReport {
  double radius = 0;
  double scale = 0;      ///< S of the accuracy contract: the largest of radius and extent
  double tolerance = 0;  ///< 1e-9 S, or 64 steps of the coordinates where that is coarser
  std::size_t segments = 0, pieces = 0, arcs = 0, explicit_vertices = 0;
  std::vector<Check> checks;
  bool ok() const {
    for (const Check& c : checks)
      if (!c.ok()) return false;
    return true;
  }
};

/// Checks a profile against its terrain by brute force in extended precision:
///
/// - form: half-lines at both ends and nowhere else, at x_first - R and x_last + R; at most 2n + 2 vertices and n - 1
///   explicit ones; pieces go right (up and down on walls), arcs clockwise by at most half a turn;
/// - continuity: each piece starts where the one before ends;
/// - cause: arcs have radius R about the vertex they name, segments are parallel to the one they name at distance R;
/// - distance: samples of every piece are at distance R from the terrain and not below it (a point under the polyline is
///   inside however far from it);
/// - height: at random x the boundary passes through the upper envelope of all disks.
///
/// The first four already prove a continuous chain from end to end on the true boundary; the last is its counter-check.
/// Errors: radius not finite and positive, no point, a coordinate not finite, x decreases, cancelled.
Result<ProfileReport> check_profile(std::span<const Point> terrain, std::span<const input::ProfileRecord> pieces,
                                    const ProfileCheckOptions& options, const Context& context = {});

}  // namespace krepl::verify
