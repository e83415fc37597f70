// Which engine compute_zone_auto takes, and that it makes no difference to the zone.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "krepl/sweep.hpp"
#include "krepl/voronoi.hpp"
#include "support/zone_case.hpp"
#include "support/zone_comparison.hpp"

namespace krepl::test {
namespace {

/// A finely digitised circle of radius 1000, its coordinates rounded to whole steps.
std::shared_ptr<const Network> circle(int sides, double step) {
  std::vector<Point> vertices;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    vertices.push_back({std::round(1000 * std::cos(angle) / step) * step, std::round(1000 * std::sin(angle) / step) * step});
  }
  vertices.push_back(vertices[0]);
  return std::make_shared<const Network>(*network_of({{line(vertices)}}));
}

TEST(AutoEngine, TakesTheSweepInsideADigitisedCircle) {
  const auto network = circle(3000, 0x1p-10);
  AutoCounters counters;
  const auto zone = compute_zone_auto(network, {999.9}, {}, &counters);
  ASSERT_TRUE(zone.ok()) << zone.error().text();
  EXPECT_TRUE(counters.by_sweep);
  EXPECT_NE(counters.given_up.find("more than 40 cigars"), std::string::npos) << counters.given_up;
  EXPECT_GT(counters.sweep.curves, 0u);
  EXPECT_EQ(zone->validate().value_or("sound"), "sound");
  const auto by_intervals = compute_zone(network, {999.9});
  ASSERT_TRUE(by_intervals.ok());
  EXPECT_GT(by_intervals->counters().candidates, 100 * by_intervals->counters().elements);
  EXPECT_EQ(any_difference(*zone, *by_intervals).value_or("none"), "none");
}

TEST(AutoEngine, TakesIntervalsOtherwise) {
  const auto network = circle(3000, 0x1p-10);
  for (const double radius : {1.0, 100.0, 2000.0}) {
    AutoCounters counters;
    const auto zone = compute_zone_auto(network, {radius}, {}, &counters);
    ASSERT_TRUE(zone.ok());
    EXPECT_FALSE(counters.by_sweep) << radius;
    EXPECT_EQ(counters.given_up, "");
    EXPECT_EQ(any_difference(*zone, *compute_zone(network, {radius})).value_or("none"), "none");
  }
}

TEST(AutoEngine, ThreadsDoNotChangeTheChoice) {
  const auto network = circle(3000, 0x1p-10);
  const auto exact = compute_zone(network, {999.9});
  ASSERT_TRUE(exact.ok());
  const std::uint64_t mean = exact->counters().candidates / exact->counters().elements;
  for (const unsigned threads : {1u, 3u}) {
    Context context;
    context.threads = threads;
    // Just enough, and one too few.
    EXPECT_TRUE(compute_zone(network, {999.9, mean + 1}, context).ok());
    const auto refused = compute_zone(network, {999.9, mean - 1}, context);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::computation);
  }
}

TEST(AutoEngine, FaultsOfUseStayThose) {
  AutoCounters counters;
  const auto zone = compute_zone_auto(circle(10, 0x1p-10), {-1}, {}, &counters);
  ASSERT_FALSE(zone.ok());
  EXPECT_EQ(zone.error().code, ErrorCode::usage);
  EXPECT_EQ(counters.given_up, "");
}

TEST(AutoEngine, ADiagramIsGivenUpWhereAllFacesMeet) {
  const auto network = circle(2500, 0x1p-42);  // all faces meet in the centre
  VoronoiOptions limits;
  limits.most_candidates = diagram_budget(*network, 1);
  for (const unsigned threads : {1u, 3u}) {
    Context context;
    context.threads = threads;
    const auto refused = VoronoiDiagram::build(network, context, limits);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::computation);
  }
  limits.most_candidates = diagram_budget(*network, 1000);
  const auto diagram = VoronoiDiagram::build(network, {}, limits);
  ASSERT_TRUE(diagram.ok()) << diagram.error().text();
  EXPECT_GT(diagram->counters().candidates, diagram_budget(*network, 1));
  EXPECT_EQ(difference(*diagram->zone({999.9}), *compute_zone(network, {999.9})).value_or("none"), "none");
}

}  // namespace
}  // namespace krepl::test
