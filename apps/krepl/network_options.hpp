#pragma once

#include <string>

#include "input/network_reader.hpp"

namespace CLI {
class App;
}

namespace krepl::app {

/// Declares --layer, --where, --crs, --to-crs and --format, as every verb that reads a network has them. What is given
/// must live until the verb has run.
void add_network_options(CLI::App& verb, input::NetworkRequest& input, std::string& format);

}  // namespace krepl::app
