#pragma once

#include <string>

#include "terrain_options.hpp"
#include "verify/input_parts.hpp"
#include "verify/route_verifier.hpp"

namespace krepl::app {

/// A route to be checked; texts as given on the command line.
struct RouteVerification {
  std::string result;
  verify::InputRequest input;
  TerrainOptions terrain;  ///< beside the path and the coordinate systems of `input`
  std::string radius, max_error, ceiling, max_slope;
  std::uint64_t samples = 0;
};

/// Prints what was found and a table of checks. Returns the exit status.
int verify_route(const RouteVerification& job, Session& session);

/// "is not the WHAT of radius R: names of the broken checks, near X Y".
Error violation(const char* what, double radius, const std::vector<verify::Check>& checks);

}  // namespace krepl::app
