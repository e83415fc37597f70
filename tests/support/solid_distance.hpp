#pragma once

#include <array>
#include <span>

#include "krepl/point.hpp"

namespace krepl::test {

/// Distance from a point to the nearest of some triangles and everything below them, in extended precision and by no
/// formula of the library: 0 inside.
long double solid_distance(std::span<const std::array<Point3, 3>> triangles, Point3 p);

}  // namespace krepl::test
