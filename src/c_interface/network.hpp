#pragma once

#include <memory>

#include "krepl/krepl.h"
#include "krepl/network.hpp"

/// Zones share the network, so that it may be destroyed before them.
struct krepl_network {
  std::shared_ptr<const krepl::Network> network;
};
