// Connected components of free space against flood fill on fine grids, against routes, and in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "krepl/free_components.hpp"
#include "krepl/route.hpp"
#include "support/environment.hpp"
#include "support/zone_case.hpp"
#include "support/zone_generators.hpp"

namespace krepl::test {
namespace {

using Random = std::mt19937_64;
constexpr std::uint32_t none = FreeComponents::none;

Result<FreeComponents> components_of(const ZoneCase& c) {
  Result<Network> network = network_of(c);
  if (!network) return network.error();
  return FreeComponents::build(std::make_shared<const Network>(std::move(*network)), c.radius);
}

ZoneCase random_case(Random& random) {
  std::vector<std::uint8_t> bytes(20 + random() % 100);
  for (std::uint8_t& b : bytes) b = std::uint8_t(random());
  return decode(bytes);
}

ZoneCase box_with_gap(double gap) {
  return {{line({{0, gap}, {0, 10}, {10, 10}, {10, 0}, {0, 0}})}, 1};
}

TEST(FreeComponents, InsideAndOutsideOfABox) {
  const auto parts = components_of(box_with_gap(0));
  ASSERT_TRUE(parts) << parts.error().text();
  EXPECT_EQ(parts->count(), 2u);
  EXPECT_EQ(parts->at({5, 5}), 1u);
  EXPECT_EQ(parts->at({-5, 5}), 0u);
  EXPECT_EQ(parts->at({1e9, -3}), 0u);
  EXPECT_EQ(parts->at({0.5, 5}), none) << "the disk overlaps the wall";
  EXPECT_EQ(parts->at({NAN, 5}), none);
  EXPECT_FALSE(parts->same({5, 5}, {-5, 5}));
  EXPECT_TRUE(parts->same({1, 1}, {9, 9})) << "touching two walls each";
  EXPECT_FALSE(parts->same({0, 5}, {0, 5})) << "not free";
}

TEST(FreeComponents, AGapOfExactlyTheDiskIsOpen) {
  const auto open = components_of(box_with_gap(2)), closed = components_of(box_with_gap(2 - 1e-9));
  ASSERT_TRUE(open && closed);
  EXPECT_TRUE(open->same({5, 5}, {-5, 5}));
  EXPECT_EQ(open->at({0, 1}), 0u) << "in the gap itself";
  EXPECT_FALSE(closed->same({5, 5}, {-5, 5}));
  EXPECT_EQ(closed->at({0, 1}), none);
}

TEST(FreeComponents, RoomsInRooms) {
  ZoneCase c;
  for (int k = 0; k < 5; ++k) {
    const double a = 10.0 * k, b = 100 - a;
    c.parts.push_back(line({{a, a}, {b, a}, {b, b}, {a, b}, {a, a}}));
  }
  c.radius = 2;
  const auto parts = components_of(c);
  ASSERT_TRUE(parts);
  EXPECT_EQ(parts->count(), 6u);
  std::vector<std::uint32_t> found;
  for (double x : {-5.0, 5.0, 15.0, 25.0, 35.0, 50.0}) found.push_back(parts->at({x, 50}));
  std::vector<std::uint32_t> sorted = found;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(sorted, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(parts->at({5, 5}), found[1]);
  EXPECT_EQ(parts->at({95, 45}), found[1]) << "around the inner rooms";
  EXPECT_EQ(parts->at({100, 50}), none);
}

TEST(FreeComponents, PolygonsAreFilledAndTheirHolesAreRooms) {
  const ZoneCase c{{ring({{0, 0}, {30, 0}, {30, 30}, {0, 30}}), ring({{10, 10}, {20, 10}, {20, 20}, {10, 20}})}, 1};
  const auto parts = components_of(c);
  ASSERT_TRUE(parts);
  EXPECT_EQ(parts->count(), 2u);
  EXPECT_EQ(parts->at({15, 15}), 1u);
  EXPECT_EQ(parts->at({5, 5}), none);
  EXPECT_EQ(parts->at({40, 5}), 0u);
}

TEST(FreeComponents, RadiusFinerThanTheCoordinatesIsAnError) {
  const ZoneCase c{{line({{1e9, 0}, {1e9 + 1, 1}})}, 1e-7};
  const auto parts = components_of(c);
  ASSERT_FALSE(parts);
  EXPECT_EQ(parts.error().code, ErrorCode::usage);
}

struct Frame {
  double west = 1e300, east = -1e300, south = 1e300, north = -1e300;
};
Frame frame_of(const ZoneCase& c) {
  Frame f;
  for (const InputPart& part : c.parts)
    for (const Point& p : part.vertices) {
      f.west = std::min(f.west, p.x), f.east = std::max(f.east, p.x);
      f.south = std::min(f.south, p.y), f.north = std::max(f.north, p.y);
    }
  const double margin = 1.5 * c.radius + 1e-3 * (f.east - f.west + f.north - f.south);
  f.west -= margin, f.east += margin, f.south -= margin, f.north += margin;
  return f;
}

/// Grid places joined where the disk is free with room for the way between them; clearance is that of DiskFreeSpace, which knows
/// nothing of zones. What is joined is in one component. What is not may be in one, through a gap too narrow for the grid.
void compare_with_flood(const ZoneCase& c, int steps, std::size_t& joined, std::size_t& apart) {
  const auto parts = components_of(c);
  if (!parts && parts.error().code == ErrorCode::usage) return;  // a radius finer than the coordinates
  ASSERT_TRUE(parts) << c << parts.error().text();
  const Frame f = frame_of(c);
  const double dx = (f.east - f.west) / steps, dy = (f.north - f.south) / steps;
  const auto place = [&](int i) { return Point{f.west + (i % (steps + 1)) * dx, f.south + (i / (steps + 1)) * dy}; };
  const int count = (steps + 1) * (steps + 1);
  std::vector<double> clearance(std::size_t(count), 0.0);
  std::vector<std::uint32_t> component(std::size_t(count), none);
  for (int i = 0; i < count; ++i) {
    clearance[std::size_t(i)] = parts->space().clearance(place(i)).clearance;
    component[std::size_t(i)] = parts->at(place(i));
    ASSERT_EQ(component[std::size_t(i)] == none, clearance[std::size_t(i)] < 0) << c;
  }
  // Of the border of the frame all is free and outside.
  ASSERT_EQ(component[0], 0u) << c;
  for (int i = 0; i < count; ++i) {
    for (const int j : {i + 1, i + steps + 1}) {
      if (j >= count || (j == i + 1 && j % (steps + 1) == 0)) continue;
      const double step = j == i + 1 ? dx : dy, a = clearance[std::size_t(i)], b = clearance[std::size_t(j)];
      // Clearance changes by no more than the way: with that much at both ends all of it is free.
      if (a < 0 || b < 0) continue;
      if (a + b >= step) {
        ++joined;
        ASSERT_EQ(component[std::size_t(i)], component[std::size_t(j)]) << c << " at " << place(i).x << " " << place(i).y;
      } else if (component[std::size_t(i)] != component[std::size_t(j)]) {
        ++apart;
      }
    }
  }
}

TEST(FreeComponents, FloodFillJoinsNothingThatIsApart) {
  Random random(seed());
  std::size_t joined = 0, apart = 0;
  const int cases = int(60 * effort()) + 8;
  for (int n = 0; n < cases; ++n) {
    const ZoneCase c = random_case(random);
    compare_with_flood(c, 60, joined, apart);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(joined, 1000u);
}

/// The route either finds a way or says that there is none: by another search, over tangents.
TEST(FreeComponents, RoutesExistWithinComponentsOnly) {
  Random random(seed() + 1);
  int same = 0, different = 0;
  const int cases = int(60 * effort()) + 8;
  for (int n = 0; n < cases; ++n) {
    const ZoneCase c = random_case(random);
    const auto network = std::make_shared<const Network>(*network_of(c));
    const auto parts = FreeComponents::build(network, c.radius);
    if (!parts && parts.error().code == ErrorCode::usage) continue;
    ASSERT_TRUE(parts) << c << parts.error().text();
    const Frame f = frame_of(c);
    std::uniform_real_distribution<double> x(f.west, f.east), y(f.south, f.north);
    for (int k = 0; k < 4; ++k) {
      const Point from{x(random), y(random)}, to{x(random), y(random)};
      if (parts->at(from) == none || parts->at(to) == none) continue;
      RouteOptions options;
      options.radius = c.radius, options.from = from, options.to = to;
      const auto route = compute_route(network, options);
      EXPECT_EQ(route.ok(), parts->same(from, to)) << c << (route ? "" : route.error().text());
      (parts->same(from, to) ? same : different) += 1;
    }
  }
  EXPECT_GT(same, 5);
  RecordProperty("different", different);
}

/// Walls of random heights with doors about as wide as the disk: which rooms hang together is known by the widths.
TEST(FreeComponents, DoorsOfARowOfRooms) {
  Random random(seed() + 2);
  const int cases = int(40 * effort()) + 8;
  for (int n = 0; n < cases; ++n) {
    ZoneCase c;
    c.radius = 1;
    const int rooms = 8;
    c.parts.push_back(line({{0, 0}, {10.0 * rooms, 0}, {10.0 * rooms, 10}, {0, 10}, {0, 0}}));
    std::vector<bool> open;
    for (int k = 1; k < rooms; ++k) {
      constexpr double widths[] = {0, 1, 1.999999, 2, 2.000001, 4};
      const double width = widths[random() % 6], low = 3 + double(random() % 5) / 8;
      c.parts.push_back(line({{10.0 * k, 0}, {10.0 * k, low}}));
      c.parts.push_back(line({{10.0 * k, low + width}, {10.0 * k, 10}}));
      open.push_back(width >= 2);
    }
    const auto parts = components_of(c);
    ASSERT_TRUE(parts) << parts.error().text();
    EXPECT_EQ(parts->count(), 2 + std::size_t(std::count(open.begin(), open.end(), false))) << c;
    for (int k = 0; k + 1 < rooms; ++k)
      EXPECT_EQ(parts->same({10.0 * k + 5, 5}, {10.0 * k + 15, 5}), open[std::size_t(k)]) << c;
    EXPECT_FALSE(parts->same({5, 5}, {-5, 5}));
  }
}

TEST(FreeComponents, ManyAtOnceAreTheSame) {
  Random random(seed() + 3);
  const ZoneCase c = box_with_gap(0);
  const auto parts = components_of(c);
  ASSERT_TRUE(parts);
  std::vector<Point> places;
  std::uniform_real_distribution<double> at(-5, 15);
  for (int i = 0; i < 5000; ++i) {
    const double x = at(random);
    places.push_back({x, at(random)});
  }
  std::vector<std::uint32_t> one(places.size()), two(places.size());
  Context single, pair;
  single.threads = 1, pair.threads = 2;
  ASSERT_TRUE(parts->at(places, one, single));
  ASSERT_TRUE(parts->at(places, two, pair));
  EXPECT_EQ(one, two);
  for (std::size_t i = 0; i < places.size(); ++i) ASSERT_EQ(one[i], parts->at(places[i]));
  std::vector<std::uint32_t> few(3);
  EXPECT_FALSE(parts->at(places, few));
}

}  // namespace
}  // namespace krepl::test
