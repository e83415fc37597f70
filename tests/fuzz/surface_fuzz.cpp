#include "fuzz/surface_fuzz.hpp"

#include <algorithm>

namespace krepl::test {

namespace {

/// More bytes find no other faults, only later.
constexpr std::size_t most_bytes = 64;

std::optional<std::string> fault_with_text(const SmallTerrain& c, const SurfaceEffort& effort = {.points = 3, .lines = 3}) {
  const auto fault = fault_in(c, effort);
  if (!fault) return std::nullopt;
  return *fault + "\n" + text(c);
}

}  // namespace

std::optional<std::string> fuzz_surface(std::span<const std::uint8_t> bytes) {
  return fault_with_text(decode_small_terrain(bytes.first(std::min(bytes.size(), most_bytes))));
}

std::optional<std::string> fuzz_surface(SmallTerrainFamily family, std::span<const std::uint8_t> bytes) {
  return fault_with_text(decode_small_terrain(family, bytes.first(std::min(bytes.size(), most_bytes))));
}

std::optional<std::string> fuzz_small_surface(std::span<const std::uint8_t> bytes) {
  static constexpr SmallTerrainFamily families[] = {SmallTerrainFamily::grid, SmallTerrainFamily::holes,
                                                    SmallTerrainFamily::diagonals, SmallTerrainFamily::steps,
                                                    SmallTerrainFamily::soup};
  if (bytes.empty()) return std::nullopt;
  const SmallTerrainFamily family = families[bytes[0] % std::size(families)];
  const std::size_t most = family == SmallTerrainFamily::soup ? 10 : 24;  // three triangles, or few samples that are not 0
  const auto left = bytes.subspan(1);
  return fault_with_text(decode_small_terrain(family, left.first(std::min(left.size(), most))),
                         {.points = 3, .lines = 3, .seconds = 60});
}

}  // namespace krepl::test
