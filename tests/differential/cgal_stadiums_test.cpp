// Zones against exact arrangements of stadiums, on small inputs full of ties.
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "differential/cgal_stadiums.hpp"
#include "support/environment.hpp"
#include "support/zone_case.hpp"

namespace krepl::test {
namespace {

// Zones that touch are one in krepl, whose radius is that much larger; exact sets would only touch. So the exact radius
// is R + 2^-36: far above krepl's own excess, far below the distance between different radii at which integer data
// touch.
constexpr long denominator = 1l << 36;

void expect_equal(const std::vector<ExactSegment>& segments, long quarter_radii) {
  ZoneCase c{{}, double(quarter_radii) / 4};
  for (const ExactSegment& s : segments) {
    if (s.length == 0)
      c.parts.push_back(point(double(s.ax), double(s.ay)));
    else
      c.parts.push_back(line({{double(s.ax), double(s.ay)}, {double(s.bx), double(s.by)}}));
  }
  SCOPED_TRACE(text(c));
  const auto zone = zone_of(c);
  ASSERT_TRUE(zone.ok()) << zone.error().text();
  const ExactZone exact = exact_zone(segments, quarter_radii * (denominator / 4) + 1, denominator);
  EXPECT_EQ(counts(*zone), (RingCounts{exact.polygons, exact.holes}));
  EXPECT_NEAR(zone->area(), exact.area, 1e-9 * exact.area);
}

/// Integer segments of integer length: along the axes and along 3-4-5, 5-12-13 and 8-15-17.
ExactSegment random_segment(std::mt19937_64& random) {
  static constexpr std::array<std::array<long, 3>, 5> directions{
      {{1, 0, 1}, {3, 4, 5}, {4, 3, 5}, {5, 12, 13}, {15, 8, 17}}};
  auto d = directions[random() % 10 < 5 ? 0 : random() % 5];
  if (random() % 2) std::swap(d[0], d[1]);
  if (random() % 2) d[0] = -d[0];
  const long n = d[2] == 1 ? long(random() % 13) : long(random() % 3);
  const long x = long(random() % 16), y = long(random() % 16);
  return {x, y, x + n * d[0], y + n * d[1], n * d[2]};
}

TEST(AgainstCgal, RandomStadiums) {
  std::mt19937_64 random(seed());
  const int cases = int(1500 * effort());
  for (int k = 0; k < cases; ++k) {
    std::vector<ExactSegment> segments(1 + random() % 9);
    for (ExactSegment& s : segments) s = random_segment(random);
    expect_equal(segments, 1 + long(random() % 24));
  }
  std::printf("%d cases\n", cases);
}

TEST(AgainstCgal, Ties) {
  const std::vector<ExactSegment> square{
      {0, 0, 10, 0, 10}, {10, 0, 10, 10, 10}, {10, 10, 0, 10, 10}, {0, 10, 0, 0, 10}};
  for (const long quarters : {4, 19, 20, 21}) expect_equal(square, quarters);
  expect_equal({{0, 0, 0, 0, 0}, {2, 0, 2, 0, 0}, {2, 2, 2, 2, 0}, {0, 2, 0, 2, 0}}, 4);
  expect_equal({{0, 0, 10, 0, 10}, {0, 2, 10, 2, 10}}, 4);
  expect_equal({{0, 0, 30, 40, 50}, {-8, 6, 22, 46, 50}}, 20);
  expect_equal({{16, 63, 16, 63, 0},
                {-16, 63, -16, 63, 0},
                {63, 16, 63, 16, 0},
                {63, -16, 63, -16, 0},
                {-65, 0, -65, 0, 0},
                {0, -65, 0, -65, 0},
                {-39, -52, -39, -52, 0},
                {39, -52, 39, -52, 0}},
               260);
}

/// Star-shaped polygons with random vertices: simple, with reflex corners that the offset closes.
TEST(AgainstCgal, OffsetPolygons) {
  std::mt19937_64 random(seed());
  const auto unit = [&] { return double(random() >> 11) * 0x1p-53; };
  for (int k = 0; k < int(40 * effort()); ++k) {
    const int n = 5 + int(random() % 10);
    std::vector<Point> v;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.8 * unit()) / n, r = 2 + 8 * unit();
      v.push_back({std::round(1024 * r * std::cos(angle)) / 1024, std::round(1024 * r * std::sin(angle)) / 1024});
    }
    const double radius = 0.25 + 2 * unit(), error = 1e-6;
    const ZoneCase c{{ring(v)}, radius};
    SCOPED_TRACE(text(c));
    const auto zone = zone_of(c);
    ASSERT_TRUE(zone.ok()) << zone.error().text();
    const ExactZone offset = approximate_offset(v, radius, error);
    EXPECT_EQ(counts(*zone), (RingCounts{offset.polygons, offset.holes}));
    EXPECT_NEAR(zone->area(), offset.area, error * zone->perimeter());
  }
}

}  // namespace
}  // namespace krepl::test
