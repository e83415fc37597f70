#pragma once

#include <span>

#include "krepl/error.hpp"
#include "krepl/network.hpp"

namespace krepl::zone {

/// Error budget, in terms of S = max(R, extent) and u, the unit in the last place of the largest output coordinate:
///   g: radius enlarged by     max(4 u, 2^-48 S) , so that what comes that close merges     <= 3.6e-15 S
///   vertices moved by         2^-72 extent, in ill-conditioned places only                 <= 2.2e-22 S
///   evaluation of a vertex    a few u                                                      ~ 1e-15 S
///   contraction of pieces     up to 64 g along the boundary, g off it                      <= 2.3e-13 S
/// where u <= 2^-52 S unless the data lies far from its own origin, when u is what the format can hold; g and 64 g are
/// capped at 2^-31 S there. Vertices are evaluated with the nominal radius where that shifts them by at most a quarter
/// of the length below which pieces are contracted.
struct Precision {
  double effective_radius;
  double resolution;
};

/// ErrorCode::usage or input if the radius is not positive and finite, or too fine or too large for the coordinates.
Result<Precision> precision_for(const Network& network, double radius);
/// The same for several radii at once: effective_radius is that of the largest.
Result<Precision> precision_for(const Network& network, double least, double most);
/// The same where the extent is more than that of the network's vertices.
Result<Precision> precision_for(double extent, double resolution, double least, double most);

/// A radius for each part of the network, all of them positive: else as above, or ErrorCode::usage for another number of them.
Status check_part_radii(const Network& network, std::span<const double> part_radii);

}  // namespace krepl::zone
