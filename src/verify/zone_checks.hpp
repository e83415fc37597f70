#pragma once

#include <array>
#include <cstdint>

#include "verify/boundary.hpp"
#include "verify/obstacle.hpp"
#include "verify/tally.hpp"
#include "verify/zone_verifier.hpp"

namespace krepl::verify {

/// What the checks of one zone share.
struct ZoneCase {
  const Obstacle& obstacle;
  const Boundary& boundary;
  Real radius;
  Real tolerance;  ///< of true curves
  Real deviation;  ///< tolerance, and what a linear format was allowed
  std::uint64_t samples;
  double effort;
  std::uint64_t seed;
  const Context& context;
};

Check check_joins(const ZoneCase& zone);
Check check_centres(const ZoneCase& zone);
Check check_distances(const ZoneCase& zone);
Check check_membership(const ZoneCase& zone);
Check check_coverage(const ZoneCase& zone);
/// On parallel lines: the difference of lengths, and the area against Green's formula.
std::array<Check, 2> check_areas(const ZoneCase& zone);
Check check_crossings(const ZoneCase& zone);
Check check_nesting(const ZoneCase& zone);

}  // namespace krepl::verify
