#pragma once

#include <random>

#include "support/zone_case.hpp"

namespace krepl::test {

/// Kinds of lines with arcs that a zone engine stumbles over.
enum class CurveFamily : std::uint8_t {
  grid,        ///< arcs and segments over the points of a small grid
  circles,     ///< full circles on a grid, R often a multiple of half their radii: tangent, concentric, coinciding
  concentric,  ///< arcs about one centre, r1 + R = r2 - R and the like
  one_circle,  ///< arcs that overlap on one circle, equal and turned round
  tangent,     ///< lines and arcs that go on in one direction: roads, tool paths
  flat,        ///< arcs of tiny height and vast radius
  crossing,    ///< random arcs and segments of all sizes
  fillets,     ///< rings of straight sides with rounded corners, filled
  arc_rings,   ///< rings of arcs on a grid, by the even-odd rule
  near_equal,  ///< grid arcs moved by 2^-30 .. 2^-52
  count
};

const char* name(CurveFamily f);

/// A random case of a family.
ZoneCase random_curves(CurveFamily family, std::mt19937_64& random);

}  // namespace krepl::test
