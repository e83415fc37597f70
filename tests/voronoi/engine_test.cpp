// The zones out of the diagram are those of the covered-intervals engine, on every family of degenerate input.
#include <cstdio>

#include "krepl/voronoi.hpp"
#include "support/zone_comparison.hpp"
#include "support/zone_property.hpp"

namespace krepl::test {
namespace {

using VoronoiEngine = PropertyTest;

/// What cannot be certified must end with an error, never with a wrong diagram, and rarely.
struct Tally {
  int all = 0, refused = 0;
};

std::optional<std::string> fault_of_engines(const ZoneCase& c, Tally& tally) {
  auto network = network_of(c);
  if (!network) return std::nullopt;  // the generators also make what is refused
  const auto shared = std::make_shared<const Network>(std::move(*network));
  const auto diagram = VoronoiDiagram::build(shared);
  ++tally.all;
  if (!diagram) {
    ++tally.refused;
    if (diagram.error().code != ErrorCode::computation) return diagram.error().text();
    return std::nullopt;
  }
  if (auto wrong = diagram->validate()) return wrong;
  for (const double factor : {0.25, 1.0, 1.5, 8.0}) {
    const ZoneOptions options{c.radius * factor};
    const auto by_intervals = compute_zone(shared, options);
    if (!by_intervals || options.radius >= diagram->horizon()) continue;  // too fine, or too large for the diagram
    const auto by_diagram = diagram->zone(options);
    if (!by_diagram) return "R = " + std::to_string(options.radius) + ": " + by_diagram.error().text();
    if (auto wrong = by_diagram->validate()) return "R = " + std::to_string(options.radius) + ": " + *wrong;
    if (auto differ = difference(*by_intervals, *by_diagram))
      return "R = " + std::to_string(options.radius) + ": " + *differ;
  }
  return std::nullopt;
}

TEST_P(VoronoiEngine, AgreesWithIntervals) {
  Tally tally;
  holds("agrees with the engine by intervals", [&](const ZoneCase& c) {
    const auto fault = fault_of_engines(c, tally);
    if (fault) RC_LOG() << *fault << '\n';
    RC_ASSERT(!fault);
  });
  std::printf("%d of %d diagrams refused\n", tally.refused, tally.all);
  EXPECT_LE(tally.refused, tally.all / 200 + 1);
}

KREPL_FOR_ALL_FAMILIES(VoronoiEngine);

}  // namespace
}  // namespace krepl::test
