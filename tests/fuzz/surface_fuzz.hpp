#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "support/surface_faults.hpp"

namespace krepl::test {

/// Decodes a small terrain, computes its surface and checks it by validate() and brute force; what is wrong and the
/// case as text, or nothing.
std::optional<std::string> fuzz_surface(std::span<const std::uint8_t> bytes);
/// The same for what computes in a hundredth of a second: grids with and without holes, with walls, a few triangles. Nothing of
/// it is late.
std::optional<std::string> fuzz_small_surface(std::span<const std::uint8_t> bytes);
/// The same for terrains of one kind.
std::optional<std::string> fuzz_surface(SmallTerrainFamily family, std::span<const std::uint8_t> bytes);

}  // namespace krepl::test
