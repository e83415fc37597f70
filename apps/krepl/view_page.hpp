#pragma once

#include <string>

#include "input/network_reader.hpp"
#include "terrain_options.hpp"
#include "tool_programs.hpp"

namespace krepl::app {

class Session;

struct ViewOptions {
  std::string result, output, title;
  input::NetworkRequest input;  // path empty: none
  TerrainOptions terrain;       // of surfaces and tool paths, beside `input`
  ProgramOptions program;       // of tool paths, beside `result`
  std::string max_error;        // of surfaces, as given

  bool has_surface_options() const;
  bool has_program_options() const;
};

std::string page_title(const ViewOptions& options);

/// The code that a coordinate system's name ends with: "WGS 84 / UTM zone 32N (EPSG:32632)" -> "EPSG:32632".
std::string code_in(const std::string& crs_name);

/// The short name of a coordinate system's unit of length; empty if it cannot be told.
std::string unit_of(const std::string& crs_name);

/// Writes the page and tells about it; returns the exit status.
int write_page(const ViewOptions& options, const std::string& html, const std::string& contents, Session& session);

/// Whether a result is a surface: a subdivision as .json or .gpkg.
bool is_surface(const std::string& path);
int run_surface_view(const ViewOptions& options, Session& session);
int run_path_view(const ViewOptions& options, Session& session);

}  // namespace krepl::app
