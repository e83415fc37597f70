#pragma once

#include <string>

#include "input/network_reader.hpp"

namespace CLI {
class App;
}

namespace krepl::app {

/// Declares --arc-error, a length above zero.
void add_arc_option(CLI::App& verb, double& arc_error);

/// Declares --layer, --where, --crs, --to-crs, --arc-error and --format, as every verb that reads a network has them. What is given
/// must live until the verb has run.
void add_network_options(CLI::App& verb, input::NetworkRequest& input, std::string& format);

}  // namespace krepl::app
