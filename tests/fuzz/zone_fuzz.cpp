#include "fuzz/zone_fuzz.hpp"

#include "support/zone_generators.hpp"

namespace krepl::test {

std::optional<std::string> fuzz_zone(std::span<const std::uint8_t> bytes) {
  // More bytes find no other faults, only later.
  const ZoneCase c = decode(bytes.first(std::min<std::size_t>(bytes.size(), 160)));
  const auto fault = fault_in(c, 0.005);
  if (!fault) return std::nullopt;
  return *fault + "\n  " + text(c);
}

}  // namespace krepl::test
