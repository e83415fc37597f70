#pragma once

#include <cstdint>
#include <span>

#include "support/zone_case.hpp"

namespace krepl::test {

/// Kinds of input that zone engines stumble over.
enum class Family : std::uint8_t {
  grid_lines,   ///< polylines on a small integer grid: crossings, overlaps, repeated vertices, spikes
  grid_points,  ///< isolated points on a small integer grid
  streets,      ///< a street grid, upright or turned, with R about half a block
  on_segments,  ///< vertices computed to lie on other segments, off by rounding
  collinear,    ///< many overlapping segments of one line
  tangent,      ///< parallels and points at distance exactly 2R
  cocircular,   ///< vertices on one circle of radius R, alone or joined
  near_equal,   ///< grid lines whose vertices are moved by 2^-30 .. 2^-52
  rings,        ///< polygon rings on a small integer grid, by the even-odd rule
  digitised,    ///< a finely digitised circle of radius near R
  scattered,    ///< random doubles, short and long segments mixed
  comb,         ///< a line with many teeth, doubled back on itself
  count
};

/// Makes a case from bytes: family, radius, a motion (none, turned, shifted far, scaled), then vertices. Any bytes give
/// a case with at least one vertex; the same bytes the same case; fewer and smaller bytes a simpler one.
ZoneCase decode(std::span<const std::uint8_t> bytes);
/// The same with the family given rather than read.
ZoneCase decode(Family family, std::span<const std::uint8_t> bytes);

}  // namespace krepl::test
