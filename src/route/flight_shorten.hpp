#pragma once

#include <vector>

#include "route/flight_lattice.hpp"

namespace krepl::route {

/// Makes a free polyline cheaper, keeping it proven free, within the rules and over the terrain: leaves out points,
/// then cuts corners, until that gains little. The ends stay.
std::vector<Point3> shorten_flight(std::vector<Point3> points, const FlightRules& rules, FlightProof& proof,
                                   const Context& context);

}  // namespace krepl::route
