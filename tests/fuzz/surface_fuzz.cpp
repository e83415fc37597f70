#include "fuzz/surface_fuzz.hpp"

#include <algorithm>

namespace krepl::test {

namespace {

/// More bytes find no other faults, only later.
constexpr std::size_t most_bytes = 64;

std::optional<std::string> fault_with_text(const SmallTerrain& c) {
  const auto fault = fault_in(c, {.points = 3, .lines = 3});
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

}  // namespace krepl::test
