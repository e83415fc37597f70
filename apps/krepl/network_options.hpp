#pragma once

#include <string>

#include "command_line.hpp"
#include "input/network_reader.hpp"

namespace krepl::app {

/// Declares --arc-error, a length above zero.
void add_arc_option(Verb& verb, double& arc_error);

/// Declares --layer, --where, --crs, --to-crs, --arc-error and --format, as every verb that reads a network has them. What is given
/// must live until the verb has run.
void add_network_options(Verb& verb, input::NetworkRequest& input, std::string& format);

}  // namespace krepl::app
