#pragma once

#include <cmath>

#include "krepl/shape.hpp"

namespace krepl::shape {

/// Where a line turns by less, in radians, bevel, arc and mitre differ by less than 2^-43 R: the arc serves for all.
/// Where it turns back by all but this, it ends.
inline constexpr double least_bend = 0x1p-20;

/// How the zone goes round a bend by that angle: as the options say, but for bends too flat and mitres too long.
inline Join join_of(const ShapeOptions& options, double angle) {
  if (angle <= least_bend) return Join::round;
  const bool too_long = !(1 <= options.mitre_limit * std::cos(angle / 2) * (1 + 1e-14));
  return options.join == Join::mitre && too_long ? Join::bevel : options.join;
}

}  // namespace krepl::shape
