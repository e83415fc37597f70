#pragma once

#include <string>

#include "krepl/route.hpp"
#include "output/zone_file.hpp"

namespace krepl::output {

struct RouteFileOptions {
  std::string crs;  ///< WKT of the coordinate system; empty: none
  double max_error =
      0;  ///< largest deviation of chords from arcs, where a format has none, and from parabolas; 0: R / 1000
};

/// The format for a route: those of zones, and csv (a row for each piece), which is krepl's own.
struct RouteFormat {
  bool csv = false;
  ZoneFormat curves;  ///< if not csv
};
Result<RouteFormat> find_route_format(const std::string& path, const std::string& asked);

/// Writes a route. GeoPackage: layers `route` (the whole as one COMPOUNDCURVE) and `pieces` (each with what it turns
/// about); FlatGeobuf, WKT, WKB: the whole, true arcs; DXF: with bulges; SVG: a picture with the obstacles (`network`)
/// and their zone (null: none is drawn), parabolas as such; CSV: a row for each piece; others: the whole in chords. The
/// file appears whole or not at all.
Result<ZoneFileReport> write_route(const std::string& path, const Route& route, const Network& network,
                                   const Zone* zone, const RouteFormat& format, const RouteFileOptions& options,
                                   const Context& context = {});

}  // namespace krepl::output
