#pragma once

#include <functional>
#include <string>

#include "krepl/terrain_route.hpp"
#include "output/route_file.hpp"

namespace krepl::output {

/// For the picture: where the ball rests over a place (absolute coordinates; minus infinity where it touches nothing),
/// and the box of the terrain.
struct TerrainPicture {
  std::function<double(Point)> rest;
  Point low, high;
};

/// Writes a route over a terrain as a polyline in space: GeoPackage, GeoJSON and other formats of OGR (a LINESTRING Z
/// with `radius`, `length`, `climb`, `steepest`, `clearance`), WKT, CSV (`x,y,z,along,rest`: a row for each point, the
/// way so far and where the ball rests below it), SVG (plan over shaded heights, and profile). Errors: usage for wkb
/// and dxf; whatever keeps the file from being written; cancelled.
Result<ZoneFileReport> write_terrain_route(const std::string& path, const TerrainRoute& route,
                                           const TerrainPicture& picture, const RouteFormat& format,
                                           const std::string& crs, const Context& context = {});

/// The picture alone, as SVG.
Status write_terrain_route_svg(const std::string& path, const TerrainRoute& route, const TerrainPicture& picture,
                               const Context& context);

}  // namespace krepl::output
