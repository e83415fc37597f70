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
  Real inner;      ///< of a band, else 0
  Real tolerance;  ///< of true curves
  Real deviation;  ///< tolerance, and what a linear format was allowed
  std::uint64_t samples;
  double effort;
  std::uint64_t seed;
  const Context& context;
};

/// A result, its numbers, and how many points are to be tested.
struct MeasuredZone {
  ZoneReport report;
  Boundary boundary;
  std::uint64_t samples;
};
Result<MeasuredZone> measure(const std::vector<input::ResultPolygon>& polygons, const Obstacle& obstacle,
                             const ZoneCheckOptions& options);
ZoneCase case_of(const MeasuredZone& measured, const Obstacle& obstacle, const ZoneCheckOptions& options,
                 const Context& context);

/// Points per item so that about `budget` are tested in all, at least `least` and at most `most` an item.
std::size_t per_item(std::size_t items, double budget, std::size_t least, std::size_t most, double effort);

/// A random point of one of four kinds: anywhere, near a boundary (close by or within R), near the input.
Vec sample_point(const ZoneCase& zone, const Box& region, std::size_t i);

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
