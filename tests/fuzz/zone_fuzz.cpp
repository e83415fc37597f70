#include "fuzz/zone_fuzz.hpp"

#include "krepl/sweep.hpp"
#include "support/zone_comparison.hpp"
#include "support/zone_generators.hpp"

namespace krepl::test {

std::optional<std::string> fuzz_zone(std::span<const std::uint8_t> bytes) {
  // More bytes find no other faults, only later.
  const ZoneCase c = decode(bytes.first(std::min<std::size_t>(bytes.size(), 160)));
  const auto fault = fault_in(c, 0.005);
  if (!fault) return std::nullopt;
  return *fault + "\n  " + text(c);
}

std::optional<std::string> fuzz_engines(std::span<const std::uint8_t> bytes) {
  const ZoneCase c = decode(bytes.first(std::min<std::size_t>(bytes.size(), 160)));
  auto made = network_of(c);
  if (!made) return std::nullopt;
  const auto network = std::make_shared<const Network>(std::move(*made));
  const auto by_intervals = compute_zone(network, {c.radius});
  const auto by_sweep = compute_zone_by_sweep(network, {c.radius});
  if (by_intervals.ok() && by_sweep.ok()) {
    const auto differ = any_difference(*by_intervals, *by_sweep);
    return differ ? std::optional(*differ + "\n  " + text(c)) : std::nullopt;
  }
  if (!by_intervals && !by_sweep && by_intervals.error().text() == by_sweep.error().text()) return std::nullopt;
  return "one engine says: " + (by_sweep ? by_intervals.error() : by_sweep.error()).text() + "\n  " + text(c);
}

}  // namespace krepl::test
