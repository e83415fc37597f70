#pragma once

#include <optional>
#include <string>
#include <vector>

#include "input/result_file.hpp"
#include "krepl/error.hpp"
#include "krepl/point.hpp"

namespace krepl::input {

/// A route as found in a file, for verification and viewing: plain coordinates, nothing computed by an engine.
struct RouteRecord {
  std::vector<ResultPiece> pieces;           ///< segments and arcs, one after the other; heights are left out
  std::vector<Point3> points;                ///< of a route in space: a polyline; empty in the plane
  std::optional<double> radius, clearance;   ///< where the file tells them
  std::string crs;                           ///< name of the coordinate system, empty if unknown

  bool in_space() const { return !points.empty(); }
};

/// Whether a file that can be read holds lines in place of polygons, or is a CSV of pieces or places as `krepl route` writes them
/// (columns sense, or x, y and z).
bool looks_like_route(const std::string& path);

/// Reads the one route of a file: the layer `route`, or the only one; CSV of pieces (kind,x0,y0,x1,y1,cx,cy,sense) or of places
/// (x,y,z). Errors name feature or line: no route, more than one, not a line, a coordinate that is not finite, a line with heights
/// and arcs; a parabola in a CSV, which does not tell its directrix.
Result<RouteRecord> read_route(const std::string& path);

}  // namespace krepl::input
