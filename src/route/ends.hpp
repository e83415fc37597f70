#pragma once

#include <optional>

#include "krepl/error.hpp"
#include "krepl/network.hpp"
#include "route/obstacles.hpp"

namespace krepl::route {

/// "x y" of a place relative to the network's origin, as messages tell it.
std::string place_text(const Network& network, Point p);

/// Why a disk cannot stand at a place: which obstacle it overlaps, and how deep. Nothing if it can: obstacles may be as
/// near as `clearance`.
std::optional<Error> refuse_end(const Obstacles& obstacles, Point p, double radius, double clearance, const char* end);

}  // namespace krepl::route
