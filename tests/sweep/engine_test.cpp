// The zones by sweep are those of the covered-intervals engine, to the bit, on every family of degenerate input and
// on the corpus; and those of the Voronoi diagram, as far as that goes.
#include <algorithm>

#include "krepl/sweep.hpp"
#include "krepl/voronoi.hpp"
#include "support/environment.hpp"
#include "support/wkt_file.hpp"
#include "support/zone_comparison.hpp"
#include "support/zone_property.hpp"

namespace krepl::test {
namespace {

using SweepEngine = PropertyTest;
using CleanUp = SweepOptions::CleanUp;

std::optional<std::string> fault_of_sweep(const std::shared_ptr<const Network>& network, double radius,
                                          CleanUp clean_up) {
  const auto by_intervals = compute_zone(network, {radius});
  if (!by_intervals) return std::nullopt;  // too fine
  SweepCounters counters;
  const auto by_sweep = compute_zone_by_sweep(network, {radius, clean_up}, {}, &counters);
  if (!by_sweep) return by_sweep.error().text();
  if (counters.ties > 0) return std::to_string(counters.ties) + " ties";
  if (auto wrong = by_sweep->validate()) return wrong;
  return any_difference(*by_intervals, *by_sweep);
}

TEST_P(SweepEngine, AgreesWithIntervals) {
  holds("agrees with the engine by intervals", [&](const ZoneCase& c) {
    auto made = network_of(c);
    if (!made) return;  // the generators also make what is refused
    const auto network = std::make_shared<const Network>(std::move(*made));
    using Run = std::pair<double, CleanUp>;
    for (const auto& [factor, clean_up] :
         {Run{0.25, CleanUp::rounds}, Run{1, CleanUp::rounds}, Run{1, CleanUp::neighbours}, Run{8, CleanUp::rounds}}) {
      const auto fault = fault_of_sweep(network, c.radius * factor, clean_up);
      if (fault) RC_LOG() << "R = " << c.radius * factor << ", clean-up " << int(clean_up) << ": " << *fault << '\n';
      RC_ASSERT(!fault);
    }
  });
}

KREPL_FOR_ALL_FAMILIES(SweepEngine);

TEST(SweepCorpus, ThreeEnginesAgree) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(source_directory() / "tests" / "corpus" / "zone"))
    if (entry.path().extension() == ".wkt") paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  ASSERT_GE(paths.size(), 20u);
  for (const auto& path : paths) {
    SCOPED_TRACE(path.filename());
    auto made = network_of({read_wkt_file(path), 1});
    ASSERT_TRUE(made.ok());
    const auto network = std::make_shared<const Network>(std::move(*made));
    const auto diagram = VoronoiDiagram::build(network);
    const double size = std::max(network->extent(), 1.0);
    for (const double radius : {0.5, 1.0, 2.0, 0.01 * size, 0.1 * size, size}) {
      for (const auto clean_up : {CleanUp::rounds, CleanUp::neighbours})
        EXPECT_EQ(fault_of_sweep(network, radius, clean_up).value_or("none"), "none") << "R = " << radius;
      if (!diagram || radius >= diagram->horizon()) continue;
      const auto by_sweep = compute_zone_by_sweep(network, {radius});
      const auto by_diagram = diagram->zone({radius});
      if (!by_sweep || !by_diagram) continue;
      EXPECT_EQ(difference(*by_sweep, *by_diagram).value_or("same"), "same") << "R = " << radius;
    }
  }
}

}  // namespace
}  // namespace krepl::test
