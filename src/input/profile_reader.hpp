#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/point.hpp"

namespace krepl::input {

struct TerrainLineRequest {
  std::string path;   ///< .csv (also with .gz) with columns x and z, any OGR vector source, or `-` for CSV on standard input
  std::string layer;  ///< vector sources: needed where there is more than one
  std::string where;  ///< vector sources: OGR's SQL WHERE clause
};

struct TerrainLine {
  std::vector<Point> points;       ///< x and z, x never decreasing
  std::vector<std::string> notes;  ///< what the user should know
};

/// Reads a 2D terrain.
///
/// CSV: a header line names the columns; `x` and `z` are taken in any place, others ignored. Separated by commas, semicolons
/// or tabs (whichever the header uses); blank lines and lines that begin with # are skipped. Vector files: one line; without
/// heights its y is taken as z, with heights x is the length along it in the plane. Errors name the line (CSV) or the
/// feature and vertex: missing column, missing or non-finite number, x that decreases, no point, no line or more than one,
/// coordinates in degrees.
Result<TerrainLine> read_terrain_line(const TerrainLineRequest& request, const Context& context = {});

/// A row of a profile as found in a file, nothing computed by an engine.
struct ProfileRecord {
  enum class Kind : std::uint8_t { half_line, segment, arc };
  Kind kind = Kind::half_line;
  Point start, end;
  Point center;               ///< arcs only
  bool by_segment = false;    ///< the cause is a segment (`s3`), else a vertex (`v4`)
  std::uint64_t cause = 0;
  std::uint64_t line = 0;     ///< in the file, from 1
};

/// Reads the CSV that `krepl profile` writes. Errors name the line.
Result<std::vector<ProfileRecord>> read_profile(const std::string& path);

}  // namespace krepl::input
