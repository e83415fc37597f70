// Every real file of KREPL_DATA/vector at R = 0.1 .. 1000 mean segment lengths: the sweep gives the zone that the
// covered-intervals engine gives, to the bit. Prints what it cost beside that.
#include <cmath>
#include <cstdio>
#include <ctime>

#include <gtest/gtest.h>

#include "krepl/sweep.hpp"
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

double processor_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

TEST(SweepRealFiles, AgreeWithIntervalsAtAllRadii) {
  const auto paths = real_wkt_files();
  if (paths.empty()) GTEST_SKIP() << "no real data: set KREPL_DATA to a directory with vector/*.wkt";
  Context alone;
  alone.threads = 1;
  for (const auto& path : paths) {
    SCOPED_TRACE(path.filename());
    auto made = network_of({read_wkt_file(path), 1});
    ASSERT_TRUE(made.ok());
    const auto network = std::make_shared<const Network>(std::move(*made));
    const double n = double(network->segments().size());
    std::printf("%s: %.0f segments\n", path.filename().c_str(), n);
    for (const double lengths : {0.1, 1.0, 10.0, 100.0, 1000.0}) {
      const double radius = lengths * mean_length(*network);
      const double start = processor_seconds();
      const auto by_intervals = compute_zone(network, {radius}, alone);
      const double middle = processor_seconds();
      SweepCounters counters;
      const auto by_sweep = compute_zone_by_sweep(network, {radius}, alone, &counters);
      const double end = processor_seconds();
      ASSERT_TRUE(by_intervals.ok()) << by_intervals.error().text();
      ASSERT_TRUE(by_sweep.ok()) << by_sweep.error().text();
      EXPECT_EQ(any_difference(*by_intervals, *by_sweep).value_or("same"), "same")
          << "R = " << lengths << " mean lengths";
      EXPECT_EQ(by_sweep->validate().value_or("sound"), "sound");
      EXPECT_EQ(counters.ties, 0u);
      std::printf(
          "  R = %5g lengths: %6.2f us a segment, %5.1f times the intervals; %llu rounds, %.1f curves and %.1f "
          "crossings a segment, %.2g in quadruple\n",
          lengths, 1e6 * (end - middle) / n, (end - middle) / (middle - start),
          static_cast<unsigned long long>(counters.rounds), double(counters.curves) / n, double(counters.crossings) / n,
          double(counters.decided_in_quadruple + counters.decided_in_320_bits) / n);
    }
  }
}

}  // namespace
}  // namespace krepl::test
