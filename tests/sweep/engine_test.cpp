// The zones by sweep are those of the covered-intervals engine, on every family of degenerate input.
#include "krepl/sweep.hpp"
#include "support/zone_comparison.hpp"
#include "support/zone_property.hpp"

namespace krepl::test {
namespace {

using SweepEngine = PropertyTest;

std::optional<std::string> fault_of_sweep(const std::shared_ptr<const Network>& network, double radius,
                                          SweepOptions::CleanUp clean_up) {
  const auto by_intervals = compute_zone(network, {radius});
  if (!by_intervals) return std::nullopt;  // too fine
  SweepOptions options{radius};
  options.clean_up = clean_up;
  SweepCounters counters;
  const auto by_sweep = compute_zone_by_sweep(network, options, {}, &counters);
  if (!by_sweep) return by_sweep.error().text();
  if (counters.ties > 0) return std::to_string(counters.ties) + " ties";
  if (auto wrong = by_sweep->validate()) return wrong;
  return difference(*by_intervals, *by_sweep);
}

TEST_P(SweepEngine, AgreesWithIntervals) {
  holds("agrees with the engine by intervals", [&](const ZoneCase& c) {
    auto made = network_of(c);
    if (!made) return;  // the generators also make what is refused
    const auto network = std::make_shared<const Network>(std::move(*made));
    for (const double factor : {0.25, 1.0, 1.5, 8.0}) {
      for (const auto clean_up : {SweepOptions::CleanUp::rounds, SweepOptions::CleanUp::neighbours}) {
        const auto fault = fault_of_sweep(network, c.radius * factor, clean_up);
        if (fault) RC_LOG() << "R = " << c.radius * factor << ", clean-up " << int(clean_up) << ": " << *fault << '\n';
        RC_ASSERT(!fault);
      }
    }
  });
}

KREPL_FOR_ALL_FAMILIES(SweepEngine);

}  // namespace
}  // namespace krepl::test
