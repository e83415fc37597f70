#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "input/network_reader.hpp"
#include "krepl/error.hpp"

namespace krepl::app {

class Session;

/// The options of krepl route as given.
struct RouteVerbOptions {
  input::NetworkRequest input;
  std::string output, radius, from, to, max_error, format;
  std::string prefer = "length";
};

/// Two or three finite numbers separated by commas; an Error of code usage names what is wrong.
Result<std::vector<double>> parse_place(std::string_view option, std::string_view text);

int run_plane_route(const RouteVerbOptions& options, Session& session);

}  // namespace krepl::app
