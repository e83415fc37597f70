// The zones out of the diagram are those of the covered-intervals engine, on every family of degenerate input.
#include <cstdio>
#include <random>

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

/// Segments on parallel lines that are multiples of 2R apart, in a direction of whole numbers; several lie on each other.
ZoneCase overlapping_parallels(std::mt19937_64& random) {
  static constexpr double triples[][3] = {{3, 4, 5}, {5, 12, 13}, {8, 15, 17}, {7, 24, 25}, {1, 0, 1}};
  const auto pick = [&](int below) { return int(random() % std::uint64_t(below)); };
  const auto& triple = triples[pick(5)];
  const double dx = triple[0], dy = triple[1], span = triple[2];
  constexpr double scales[] = {1, 1e7, 0.125};
  const double scale = scales[pick(3)];
  ZoneCase c;
  c.radius = span * scale;  // lines are twice that apart
  const int count = 3 + pick(6);
  for (int i = 0; i < count; ++i) {
    const double across = 2 * pick(3), from = pick(20), to = from + 1 + pick(12);
    const auto at = [&](double along) {
      return Point{scale * (dx * along - dy * across), scale * (dy * along + dx * across)};
    };
    c.parts.push_back(line({at(from), at(to)}));
  }
  return c;
}

TEST(VoronoiEngineTies, OverlappingParallelsAtTwiceTheRadius) {
  std::mt19937_64 random(20060401);
  Tally tally;
  for (int i = 0; i < 500; ++i) {
    const ZoneCase c = overlapping_parallels(random);
    const auto fault = fault_of_engines(c, tally);
    ASSERT_FALSE(fault) << *fault << "\n" << text(c);
  }
  EXPECT_LE(tally.refused, tally.all / 100);
}

}  // namespace
}  // namespace krepl::test
