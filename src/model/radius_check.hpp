#pragma once

#include <optional>
#include <string>

#include "krepl/error.hpp"
#include "krepl/terrain.hpp"

namespace krepl {

/// As messages tell places and sizes: nine digits.
std::string shown(double x);

/// Why a terrain and a ball are no input to an engine of surfaces: `finest` is the least radius it takes, relative to
/// S. `otherwise`: what else helps then, after "use at least R".
std::optional<Error> refuse_radius(const Terrain& terrain, double radius, double finest,
                                   const std::string& otherwise = "");

}  // namespace krepl
