#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/curve_network.hpp"
#include "krepl/error.hpp"
#include "krepl/network.hpp"

namespace krepl::input {

struct NetworkRequest {
  std::string path;    ///< any OGR vector source, .wkt, .wkb, these compressed with gzip, or `-`
  std::string layer;   ///< needed where the file has more than one
  std::string where;   ///< OGR's SQL WHERE clause
  std::string crs;     ///< coordinate system of the data, in place of what the file says (or does not say)
  std::string to_crs;  ///< plane coordinate system to project to; `auto` chooses one around the data
  double arc_error = 0;  ///< chords that deviate by no more stand for arcs; 0: arcs are refused, or kept
  bool keep_arcs = false;  ///< without `arc_error` arcs are kept; they cannot be projected
  std::vector<Point> places = {};  ///< further places, in the coordinates of the file; projected with the data
};

struct NetworkData {
  std::shared_ptr<const Network> network;
  std::shared_ptr<const CurveNetwork> curves;  ///< with their arcs, where there are some; `network` is then its straight part
  std::string crs;                 ///< WKT 2 of the network's coordinates; empty: a plane of unknown place
  std::vector<std::string> notes;  ///< what the user should know: projection chosen, heights ignored, features left out
  std::size_t features = 0;        ///< features with geometry
  std::vector<Point> places;       ///< those of the request, in the network's coordinates
};

/// Reads lines, rings and points into a Network. Feature numbers are OGR's feature ids, for WKT the line numbers.
///
/// Z and M are left out (noted). Errors: what open_geometry_source reports; no feature left; a coordinate that is NaN or
/// infinite; arcs without `arc_error` or `keep_arcs` (they are not linearised silently), or kept and to be projected; surfaces in space; degrees without `to_crs`; a place that the
/// projection does not reach. Each names the feature or line.
Result<NetworkData> read_network(const NetworkRequest& request, const Context& context = {});

}  // namespace krepl::input
