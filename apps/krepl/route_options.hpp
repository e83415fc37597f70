#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "input/network_reader.hpp"
#include "krepl/error.hpp"
#include "terrain_options.hpp"

namespace krepl::app {

class Session;

/// The options of krepl route as given.
struct RouteVerbOptions {
  input::NetworkRequest input;
  std::string output, radius, from, to, max_error, format;
  std::string prefer;      ///< in the plane
  TerrainOptions terrain;  ///< but for its path and coordinate systems, which are those of `input`
  std::string ceiling, max_slope, minimise, step;  ///< over a terrain
};

/// Two or three finite numbers separated by commas; an Error of code usage names what is wrong.
Result<std::vector<double>> parse_place(std::string_view option, std::string_view text);

/// True if a file is a mesh or a raster, by its name or, where that says nothing, by its content.
bool is_terrain(const std::string& path);

int run_plane_route(const RouteVerbOptions& options, Session& session);
int run_terrain_route(const RouteVerbOptions& options, Session& session);

}  // namespace krepl::app
