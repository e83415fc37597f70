// Every real file of KREPL_DATA/vector at R = 0.1 .. 1000 mean segment lengths: one diagram gives the rings, holes and
// areas that the covered-intervals engine gives.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "krepl/voronoi.hpp"
#include "support/environment.hpp"
#include "support/wkt_file.hpp"
#include "support/zone_comparison.hpp"

namespace krepl::test {
namespace {

double mean_length(const Network& n) {
  double sum = 0;
  for (const auto s : n.segments()) {
    sum += std::hypot(n.vertices()[s.a].x - n.vertices()[s.b].x, n.vertices()[s.a].y - n.vertices()[s.b].y);
  }
  return sum / double(n.segments().size());
}

TEST(VoronoiRealFiles, AgreeWithIntervalsAtAllRadii) {
  const auto paths = real_wkt_files();
  if (paths.empty()) GTEST_SKIP() << "no real data: set KREPL_DATA to a directory with vector/*.wkt";
  for (const auto& path : paths) {
    SCOPED_TRACE(path.filename());
    auto made = network_of({read_wkt_file(path), 1});
    ASSERT_TRUE(made.ok());
    const auto network = std::make_shared<const Network>(std::move(*made));
    const auto diagram = VoronoiDiagram::build(network);
    ASSERT_TRUE(diagram.ok()) << diagram.error().text();
    EXPECT_EQ(diagram->validate().value_or("sound"), "sound");
    std::printf("%s: %zu segments, %zu faces, %zu edges\n", path.filename().c_str(), network->segments().size(),
                diagram->face_count(), diagram->edge_count());
    for (const double lengths : {0.1, 1.0, 10.0, 100.0, 1000.0}) {
      const ZoneOptions options{lengths * mean_length(*network)};
      const auto by_intervals = compute_zone(network, options);
      const auto by_diagram = diagram->zone(options);
      ASSERT_TRUE(by_intervals.ok()) << by_intervals.error().text();
      ASSERT_TRUE(by_diagram.ok()) << by_diagram.error().text();
      EXPECT_EQ(difference(*by_intervals, *by_diagram).value_or("same"), "same")
          << "R = " << lengths << " mean lengths";
    }
  }
}

}  // namespace
}  // namespace krepl::test
