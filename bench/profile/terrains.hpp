#pragma once

#include <cstddef>
#include <vector>

#include "krepl/point.hpp"

namespace krepl::bench {

/// Ten kinds of terrain with segments about one unit long.
enum class Kind { rough, walk, smooth, flat, convex, concave, grooves, integer, plateaus, cliffs };
inline constexpr Kind all_kinds[] = {Kind::rough, Kind::walk, Kind::smooth, Kind::flat, Kind::convex,
                                     Kind::concave, Kind::grooves, Kind::integer, Kind::plateaus, Kind::cliffs};
const char* name(Kind kind);
/// The same points on every machine. The last one made is kept.
const std::vector<Point>& terrain(Kind kind, std::size_t segments);

}  // namespace krepl::bench
