#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "input/result_file.hpp"
#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "verify/obstacle.hpp"
#include "verify/zone_verifier.hpp"

namespace krepl::verify {

struct OwnerCheckOptions {
  double radius = 0;
  /// Deviation allowed to chords: of parabolas, and of arcs in a linear format.
  double max_error = 0;
  std::uint64_t samples = 20000;
  std::uint64_t seed = 1;
};

/// Checks shares of owners by brute force: each of many random places within the radius of the input, or inside a
/// polygon, is in the share of the nearest owner (the lowest whose polygons hold it) and in no other; places farther
/// away are in none; and each piece of a border is at the radius from the input, as far from two owners, or on a
/// polygon's ring. `owners` and `shares` correspond.
Result<std::vector<Check>> check_owners(std::span<const std::vector<InputPart>> owners,
                                        std::span<const std::vector<input::ResultPolygon>> shares,
                                        const OwnerCheckOptions& options, const Context& context = {});

}  // namespace krepl::verify
