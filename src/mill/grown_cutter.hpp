#pragma once

#include "krepl/cutter.hpp"
#include "krepl/error.hpp"

namespace krepl::mill {

/// The cutter grown by `allowance` and `room` on all sides: what it does not touch is so far from the cutter itself.
/// The tip of the result is allowance + room below that of the cutter.
///
/// Exactly so for balls, bull noses and for flat cutters with an allowance, which become bull noses. Flat cutters
/// without one stay flat, and the rims of cones and tapers stay sharp: there the result is up to roundness() times as
/// far out. Errors: a size that double precision cannot hold.
Result<Cutter> grow(const Cutter& cutter, double allowance, double room);

/// At least 1: how far grow() goes at most, in units of what was asked for. Of flat cutters without an allowance
/// sqrt(2), of flanks 1 / cos(a quarter of the angle).
double roundness(const Cutter& cutter, double allowance);

}  // namespace krepl::mill
