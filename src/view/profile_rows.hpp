#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "krepl/error.hpp"
#include "krepl/point.hpp"

namespace krepl::view {

/// A row of a profile file: columns kind,x0,y0,x1,y1,cx,cy,segment.
struct ProfileRow {
  enum class Kind : std::uint8_t { half_line, segment, arc };
  Kind kind = Kind::segment;
  Point start, end;         ///< the lower end of a half-line has y = -infinity
  Point center;             ///< arcs only
  std::int64_t cause = -1;  ///< index of the terrain's segment (kind segment) or vertex; -1 if not told
};

/// Reads a profile that `krepl profile` wrote. Errors name the line: wrong columns, not a number, a piece that does not
/// start where the one before it ends, a half-line in the middle.
Result<std::vector<ProfileRow>> read_profile_rows(const std::string& path);

/// Reads a terrain: CSV with the columns x and z (or y). Errors name the line.
Result<std::vector<Point>> read_terrain_rows(const std::string& path);

}  // namespace krepl::view
