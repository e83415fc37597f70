// Routes in the plane against the whole visibility graph, closed forms, and a grid. Every route made here is measured
// by brute force. Blind spots: scenes are small; that a long route through thousands of arcs is the shortest is not
// seen.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "krepl/route.hpp"
#include "support/environment.hpp"
#include "support/route_oracle.hpp"
#include "support/zone_generators.hpp"

namespace krepl::test {
namespace {

constexpr double pi = std::numbers::pi;

Result<Route> route_of(const ZoneCase& c, RouteOptions options) {
  auto network = network_of(c);
  if (!network) return network.error();
  options.radius = c.radius;
  return compute_route(std::make_shared<const Network>(std::move(*network)), options);
}
Result<Route> route_of(const ZoneCase& c, Point from, Point to, double weight = 0) {
  RouteOptions options;
  options.from = from, options.to = to, options.weight = weight;
  return route_of(c, options);
}
Result<Route> axis_route_of(const ZoneCase& c, Point from, Point to) {
  RouteOptions options;
  options.from = from, options.to = to, options.prefer = RoutePreference::clearance;
  return route_of(c, options);
}

void expect_length(const ZoneCase& c, Point from, Point to, double wanted) {
  const auto route = route_of(c, from, to);
  ASSERT_TRUE(route.ok()) << route.error().text() << c;
  EXPECT_EQ(fault_in_route(*route, c, from, to, true).value_or("none"), "none") << c;
  EXPECT_NEAR(route->length, wanted, 1e-9 * std::max(1.0, wanted)) << c;
}

void expect_error(const ZoneCase& c, Point from, Point to, const std::string& text) {
  const auto route = route_of(c, from, to);
  ASSERT_FALSE(route.ok()) << c;
  EXPECT_NE(route.error().text().find(text), std::string::npos) << route.error().text();
}

TEST(PlaneRoute, Straight) {
  const ZoneCase c{{point(0, 0)}, 1};
  expect_length(c, {-5, 3}, {5, 3}, 10);
  expect_length(c, {-5, 1}, {5, 1}, 10);  // grazes the point's circle
  expect_length(c, {2, 2}, {2, 2}, 0);
  EXPECT_EQ(axis_route_of(c, {2, 2}, {2, 2})->length, 0);
  EXPECT_EQ(route_of(c, {2, 2}, {2, 2}, 1)->pieces.size(), 1u);
}

TEST(PlaneRoute, AroundAPoint) {
  const ZoneCase c{{point(0, 0)}, 1};
  // Two tangents of length sqrt(5^2 - 1), and the rest of half a turn.
  expect_length(c, {-5, 0}, {5, 0}, 2 * std::sqrt(24.0) + pi - 2 * std::acos(1 / 5.0));
  // From the boundary of free space to the boundary.
  expect_length(c, {-1, 0}, {1, 0}, pi);
  expect_length(c, {0, 1}, {1, 0}, pi / 2);
  expect_length(c, {-1, 0}, {1, 1}, pi / 2 + 1);
}

TEST(PlaneRoute, AroundASegmentAlongItsSide) {
  const ZoneCase c{{line({{0, 0}, {10, 0}})}, 2};
  // Both ends on the boundary, on opposite sides: round the nearer end.
  expect_length(c, {3, 2}, {3, -2}, 6 + 2 * pi);
  expect_length(c, {8, 2}, {8, -2}, 4 + 2 * pi);
  expect_length(c, {1, 2}, {9, 2}, 8);
}

TEST(PlaneRoute, GapOfExactlyTwoRadii) {
  for (double shift : {0.0, 1e6, 0.1}) {
    const double s = shift;
    ZoneCase walls{{line({{s, 1}, {s, 100}}), line({{s, -1}, {s, -100}})}, 1};
    expect_length(walls, {s - 5, 0}, {s + 5, 0}, 10);
    const ZoneCase corridor{{line({{s, 1}, {s + 20, 1}}), line({{s, -1}, {s + 20, -1}})}, 1};
    expect_length(corridor, {s - 5, 0}, {s + 25, 0}, 30);
    expect_length(corridor, {s + 5, 0}, {s + 10, 0}, 5);
  }
  // A hair less, and the way is round.
  const ZoneCase closed{{line({{0, 1 - 1e-6}, {0, 10}}), line({{0, -1}, {0, -10}})}, 1};
  const auto route = route_of(closed, {-5, 0}, {5, 0});
  ASSERT_TRUE(route.ok());
  EXPECT_GT(route->length, 20);
  EXPECT_EQ(fault_in_route(*route, closed, {-5, 0}, {5, 0}, true).value_or("none"), "none");
}

TEST(PlaneRoute, TurnsBothWays) {
  // A slalom: an inner tangent between two circles of radius 1 at distance 4.
  const ZoneCase c{{line({{0, 0}, {0, 50}}), line({{4, 0}, {4, -50}})}, 1};
  const auto route = route_of(c, {-3, 5}, {7, -5});
  ASSERT_TRUE(route.ok()) << route.error().text();
  EXPECT_EQ(fault_in_route(*route, c, {-3, 5}, {7, -5}, true).value_or("none"), "none");
  ASSERT_EQ(route->pieces.size(), 5u);
  EXPECT_FALSE(route->pieces[1].clockwise);
  EXPECT_TRUE(route->pieces[3].clockwise);
  EXPECT_NEAR(route->pieces[2].length, std::sqrt(16.0 - 4.0), 1e-12);
  EXPECT_NEAR(route->clearance, 1, 1e-12);
}

TEST(PlaneRoute, Errors) {
  const ZoneCase box{{ring({{0, 0}, {10, 0}, {10, 10}, {0, 10}}, 7)}, 1};
  expect_error(box, {5, 5}, {20, 20}, "--from is inside the polygon of feature 7, 5 from its border");
  expect_error(box, {20, 20}, {10.25, 5}, "0.75 deep");
  expect_error(box, {20, 20}, {10.25, 5}, "touching 10 5");
  const ZoneCase fence{{line({{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}})}, 1};
  expect_error(fence, {5, 5}, {20, 20}, "--from lies in a pocket");
  expect_error(fence, {20, 20}, {5, 5}, "--to lies in a pocket");
  expect_error({fence.parts, 0}, {20, 20}, {5, 15}, "radius");
  expect_error(fence, {20, std::nan("")}, {5, 15}, "finite");
  const ZoneCase rooms{{line({{0, 0}, {20, 0}, {20, 10}, {0, 10}, {0, 0}}), line({{10, 0}, {10, 10}})}, 1};
  expect_error(rooms, {5, 5}, {15, 5}, "two different pockets");
  expect_length(rooms, {5, 5}, {3, 5}, 2);
}

TEST(PlaneRoute, DuplicateAndCollinearObstacles) {
  // The same wall whole, in pieces, twice, and with points on it.
  const ZoneCase c{{line({{0, 0}, {10, 0}}), line({{10, 0}, {5, 0}, {0, 0}}), line({{2, 0}, {7, 0}}),
                    line({{0, 0}, {10, 0}}), point(4, 0), point(4, 0)},
                   1};
  expect_length(c, {0, 1}, {10, 1}, 10);
  expect_length(c, {2, 1}, {2, -1}, 4 + pi);
}

/// A random scene with at most `vertices` vertices of each family, and two places.
struct Scene {
  ZoneCase c;
  Point from, to;
};
Scene scene(std::mt19937_64& random, unsigned vertices) {
  Scene s;
  for (;;) {
    const auto family = Family(random() % unsigned(Family::count));
    std::vector<std::uint8_t> bytes(4 + random() % 40);
    for (auto& b : bytes) b = std::uint8_t(random());
    s.c = decode(family, bytes);
    std::size_t count = 0;
    for (const auto& part : s.c.parts) count += part.vertices.size();
    if (count <= vertices) break;
  }
  double west = 1e300, east = -west, south = west, north = -west;
  for (const auto& part : s.c.parts)
    for (Point p : part.vertices)
      west = std::min(west, p.x), east = std::max(east, p.x), south = std::min(south, p.y),
      north = std::max(north, p.y);
  const double size = std::max(east - west, north - south);
  if (!(s.c.radius > size / 50) || !(s.c.radius < size))
    s.c.radius = std::max(size, 1.0) * 0.05 * double(1 + random() % 5);
  std::uniform_real_distribution<double> along(-0.3, 1.3);
  s.from = {west + along(random) * (east - west), south + along(random) * (north - south)};
  s.to = {west + along(random) * (east - west), south + along(random) * (north - south)};
  if (random() % 3 == 0) {  // where ends touch or are as degenerate as the input
    s.from = {std::round(s.from.x), std::round(s.from.y)};
    s.to = {std::round(s.to.x), std::round(s.to.y)};
  }
  return s;
}

double scale_of(const ZoneCase& c) {
  double scale = c.radius;
  for (const auto& part : c.parts)
    for (Point p : part.vertices) scale = std::max({scale, std::abs(p.x), std::abs(p.y)});
  return scale;
}

TEST(PlaneRoute, RandomScenesAgainstTheWholeVisibilityGraph) {
  const int rounds = int(600 * effort());
  std::mt19937_64 random(seed());
  int found = 0, turned = 0;
  for (int i = 0; i < rounds; ++i) {
    const Scene s = scene(random, 8);
    const double scale = scale_of(s.c), margin = 1e-10 * scale;
    const auto route = route_of(s.c, s.from, s.to);
    SCOPED_TRACE(testing::Message() << "seed " << seed() << " round " << i << ": " << s.c << " from " << s.from.x << " "
                                    << s.from.y << " to " << s.to.x << " " << s.to.y);
    if (!route && route.error().text().find("overlaps") != std::string::npos) continue;
    // With obstacles a little smaller a route is no longer, with them a little larger no shorter.
    const auto low = brute_shortest(s.c, s.from, s.to, margin), high = brute_shortest(s.c, s.from, s.to, -margin);
    if (!route) {
      EXPECT_NE(route.error().text().find("different parts of free space"), std::string::npos) << route.error().text();
      EXPECT_FALSE(high.has_value());
      continue;
    }
    ++found, turned += route->pieces.size() > 2;
    EXPECT_EQ(fault_in_route(*route, s.c, s.from, s.to, true).value_or("none"), "none");
    ASSERT_TRUE(low.has_value());
    // A tangent between circles that all but touch is as long as the root of the margin.
    const double tolerance = 1e-9 * scale + 4 * std::sqrt(margin * s.c.radius) * 1e-3;
    EXPECT_GE(route->length, *low - tolerance);
    EXPECT_LE(route->length, high.value_or(route->length) + tolerance);
  }
  EXPECT_GT(found, rounds / 4);
  EXPECT_GT(turned, rounds / 12);
}

/// Scattered points: most of what is seen is far away, and many ways are almost equally long.
TEST(PlaneRoute, ForestsAgainstTheWholeVisibilityGraph) {
  std::mt19937_64 random(seed() + 3);
  std::uniform_real_distribution<double> in(0, 1);
  for (int i = 0; i < int(24 * effort()); ++i) {
    const int count = 12 + int(random() % 12);
    ZoneCase c{{}, 0};
    for (int k = 0; k < count; ++k) c.parts.push_back(point(in(random), in(random)));
    // Disks cover from a hundredth to half of the square.
    const double covered = std::array{0.01, 0.05, 0.2, 0.5}[random() % 4];
    c.radius = std::sqrt(covered / (count * pi));
    const Point from{-2 * c.radius, in(random)}, to{1 + 2 * c.radius, in(random)};
    const auto route = route_of(c, from, to);
    ASSERT_TRUE(route.ok()) << route.error().text() << c;
    EXPECT_EQ(fault_in_route(*route, c, from, to, true).value_or("none"), "none") << c;
    // Scattered at random no gap is so near to the disk's width.
    const auto brute = brute_shortest(c, from, to, 1e-12);
    ASSERT_TRUE(brute.has_value()) << c;
    EXPECT_NEAR(route->length, *brute, 1e-9) << c;
  }
}

/// The same length there and back through thousands of points, which no brute force can look at.
TEST(PlaneRoute, LargeForestsThereAndBack) {
  std::mt19937_64 random(seed() + 4);
  std::uniform_real_distribution<double> in(0, 1);
  for (const auto& [count, covered] : {std::pair{2000, 0.01}, {2000, 0.4}, {20000, 0.03}}) {
    ZoneCase c{{}, std::sqrt(covered / (count * pi))};
    for (int k = 0; k < count; ++k) c.parts.push_back(point(in(random), in(random)));
    const Point from{-2 * c.radius, -2 * c.radius}, to{1 + 2 * c.radius, 1 + 2 * c.radius};
    const auto there = route_of(c, from, to), back = route_of(c, to, from);
    ASSERT_TRUE(there.ok() && back.ok());
    EXPECT_EQ(fault_in_route(*there, c, from, to, true).value_or("none"), "none");
    EXPECT_NEAR(there->length, back->length, 1e-10);
    EXPECT_GT(there->pieces.size(), 8u);
    // What is looked at grows with what may be on the way, not with what can be seen.
    EXPECT_LT(there->counters.tangents, 15u * unsigned(count)) << covered;
  }
}

TEST(PlaneRoute, ThereAndBackAreEquallyLong) {
  std::mt19937_64 random(seed() + 1);
  for (int i = 0; i < int(200 * effort()); ++i) {
    const Scene s = scene(random, 40);
    const auto there = route_of(s.c, s.from, s.to), back = route_of(s.c, s.to, s.from);
    ASSERT_EQ(there.ok(), back.ok()) << s.c;
    if (!there) continue;
    EXPECT_NEAR(there->length, back->length, 1e-9 * scale_of(s.c)) << s.c;
    EXPECT_EQ(fault_in_route(*back, s.c, s.to, s.from, true).value_or("none"), "none") << s.c;
  }
}

TEST(PlaneRoute, WidestByClosedForm) {
  // A room, and two gates in the wall across it: 4 wide and near, 6 wide and far.
  const ZoneCase c{{line({{-20, -20}, {20, -20}, {20, 40}, {-20, 40}, {-20, -20}}), line({{0, 2}, {0, 10}}),
                    line({{0, 16}, {0, 40}}), line({{0, -2}, {0, -20}})},
                   1};
  const Point from{-8, 0}, to{8, 0};
  expect_length(c, from, to, 16);
  const auto widest = axis_route_of(c, from, to);
  ASSERT_TRUE(widest.ok()) << widest.error().text();
  EXPECT_EQ(fault_in_route(*widest, c, from, to, false).value_or("none"), "none");
  EXPECT_NEAR(widest->widest, 3, 1e-9);
  EXPECT_NEAR(widest->clearance, 3, 1e-9);
  const auto tight = route_of(c, from, to, 1);
  ASSERT_TRUE(tight.ok()) << tight.error().text();
  EXPECT_NEAR(tight->clearance, 3, 1e-9);
  EXPECT_LT(tight->length, widest->length);
  // Up to a clearance of 2 the near gate will do, at weight (2 - 1) / (3 - 1).
  EXPECT_NEAR(route_of(c, from, to, 0.5)->length, 16, 1e-9);
  EXPECT_NEAR(route_of(c, from, to, 0.51)->clearance, 2.02, 1e-9);
}

TEST(PlaneRoute, RandomWidestAgainstAGrid) {
  std::mt19937_64 random(seed() + 2);
  int found = 0;
  for (int i = 0; i < int(60 * effort()); ++i) {
    const Scene s = scene(random, 8);
    const auto axis = axis_route_of(s.c, s.from, s.to);
    const auto shortest = route_of(s.c, s.from, s.to);
    SCOPED_TRACE(testing::Message() << "seed " << seed() << " round " << i << ": " << s.c << " from " << s.from.x << " "
                                    << s.from.y << " to " << s.to.x << " " << s.to.y);
    ASSERT_EQ(axis.ok(), shortest.ok()) << (axis.ok() ? "" : axis.error().text());
    if (!axis || s.from == s.to) continue;
    ++found;
    const double scale = scale_of(s.c);
    EXPECT_EQ(fault_in_route(*axis, s.c, s.from, s.to, false).value_or("none"), "none");
    EXPECT_GE(axis->length, shortest->length - 1e-9 * scale);
    double cell = 0;
    const double sampled = sampled_widest(s.c, s.from, s.to, 60, &cell);
    const double ends = double(std::min(clearance_of(s.c, s.from), clearance_of(s.c, s.to)));
    EXPECT_LE(sampled, axis->widest + cell);
    EXPECT_GE(axis->clearance, std::min(ends, axis->widest) - 1e-9 * scale);
    // In between: less length for less clearance, never less than asked.
    double before = shortest->length;
    for (double weight : {0.3, 0.7, 1.0}) {
      const auto between = route_of(s.c, s.from, s.to, weight);
      ASSERT_TRUE(between.ok()) << between.error().text();
      EXPECT_EQ(fault_in_route(*between, s.c, s.from, s.to, false).value_or("none"), "none");
      const double asked = s.c.radius + weight * (axis->widest - s.c.radius);
      EXPECT_GE(between->clearance, std::min(ends, asked) - 1e-9 * scale);
      EXPECT_GE(between->length, (ends >= asked ? before : 0) - 1e-9 * scale);
      before = between->length;
    }
    EXPECT_LE(before, axis->length + 1e-9 * scale);
  }
  EXPECT_GT(found, 10 * effort());
}

}  // namespace
}  // namespace krepl::test
