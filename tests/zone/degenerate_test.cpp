// Degenerate input is ordinary input: the zone is that of the point set, however it was written down.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/zone_case.hpp"

namespace krepl::test {
namespace {

using std::numbers::pi;

/// The zones of two ways to write the same point set must agree.
void expect_same(const ZoneCase& odd, const ZoneCase& plain_form) {
  SCOPED_TRACE(text(odd));
  const Result<Zone> a = zone_of(odd), b = zone_of(plain_form);
  ASSERT_TRUE(a.ok()) << a.error().text();
  ASSERT_TRUE(b.ok()) << b.error().text();
  EXPECT_EQ(fault_in(*a, odd, 0.1).value_or("sound"), "sound");
  EXPECT_EQ(counts(*a), counts(*b));
  EXPECT_NEAR(a->area(), b->area(), 1e-12 * b->area());
  EXPECT_NEAR(a->perimeter(), b->perimeter(), 1e-11 * b->perimeter());
}

TEST(Degenerate, DuplicatesAndReversals) {
  const InputPart l = line({{0, 0}, {4, 1}, {7, -2}}), back = line({{7, -2}, {4, 1}, {0, 0}});
  expect_same({{l, l, back, l}, 1}, {{l}, 1});
  expect_same({{point(1, 1), point(1, 1)}, 1}, {{point(1, 1)}, 1});
  expect_same({{line({{1, 1}, {1, 1}, {1, 1}})}, 1}, {{point(1, 1)}, 1});
  expect_same({{line({{1, 1}, {1, 1}, {5, 1}, {5, 1}, {5, 1}})}, 1}, {{line({{1, 1}, {5, 1}})}, 1});
}

TEST(Degenerate, CollinearPieces) {
  const ZoneCase whole{{line({{0, 0}, {15, 0}})}, 2};
  expect_same({{line({{0, 0}, {10, 0}}), line({{5, 0}, {15, 0}})}, 2}, whole);
  expect_same({{line({{0, 0}, {5, 0}}), line({{5, 0}, {15, 0}})}, 2}, whole);
  expect_same({{line({{0, 0}, {1, 0}, {2, 0}, {5, 0}, {14, 0}, {15, 0}})}, 2}, whole);
  expect_same({{line({{0, 0}, {15, 0}}), line({{3, 0}, {4, 0}}), point(7, 0), point(15, 0)}, 2}, whole);
  // On a slope whose points are exact.
  const ZoneCase slope{{line({{0, 0}, {12, 16}})}, 2};
  expect_same({{line({{0, 0}, {9, 12}}), line({{12, 16}, {3, 4}}), point(6, 8)}, 2}, slope);
  // On a slope whose points are not: the pieces deviate by rounding, and so may the zone.
  for (const double t : {0.1, 0.3, 0.7}) {
    const ZoneCase cut{{line({{0, 0}, {3 * t, 7 * t}}), line({{3 * t, 7 * t}, {3, 7}}), line({{0, 0}, {3, 7}})}, 0.25};
    expect_same(cut, {{line({{0, 0}, {3, 7}})}, 0.25});
  }
}

TEST(Degenerate, Spikes) {
  expect_same({{line({{0, 0}, {10, 0}, {4, 0}})}, 1}, {{line({{0, 0}, {10, 0}})}, 1});
  expect_same({{line({{0, 0}, {10, 0}, {4, 0}, {12, 0}, {-1, 0}})}, 1}, {{line({{-1, 0}, {12, 0}})}, 1});
  expect_same({{line({{0, 0}, {5, 0}, {5, 8}, {5, 0}, {10, 0}})}, 1},
              {{line({{0, 0}, {5, 0}, {10, 0}}), line({{5, 0}, {5, 8}})}, 1});
  expect_same({{ring({{0, 0}, {10, 0}, {10, 10}, {10, 20}, {10, 10}, {0, 10}})}, 1},
              {{ring({{0, 0}, {10, 0}, {10, 10}, {0, 10}}), line({{10, 10}, {10, 20}})}, 1});
}

TEST(Degenerate, ExactTangencies) {
  // Zones that touch are one.
  const auto expect_counts = [](const ZoneCase& c, RingCounts rings) {
    SCOPED_TRACE(text(c));
    const Result<Zone> zone = zone_of(c);
    ASSERT_TRUE(zone.ok()) << zone.error().text();
    EXPECT_EQ(fault_in(*zone, c, 0.1).value_or("sound"), "sound");
    EXPECT_EQ(counts(*zone), rings);
  };
  expect_counts({{point(0, 0), point(2, 0)}, 1}, {1, 0});
  expect_counts({{point(0, 0), point(6, 8)}, 5}, {1, 0});
  expect_counts({{line({{0, 0}, {10, 0}}), line({{0, 2}, {10, 2}})}, 1}, {1, 0});
  expect_counts({{line({{0, 0}, {10, 0}}), line({{20, 2}, {30, 2}, {30, 0}, {20, 0}})}, 5}, {1, 0});
  expect_counts({{line({{0, 0}, {10, 0}}), point(5, 6)}, 3}, {1, 0});
  // Four disks around a star-shaped hole, at its corners touching.
  expect_counts({{point(0, 0), point(2, 0), point(2, 2), point(0, 2)}, 1}, {1, 1});
  // Streets with R half a block: nothing stays free.
  ZoneCase grid{{}, 5};
  for (int k = 0; k <= 6; ++k) {
    grid.parts.push_back(line({{0, 10.0 * k}, {60, 10.0 * k}}));
    grid.parts.push_back(line({{10.0 * k, 0}, {10.0 * k, 60}}));
  }
  expect_counts(grid, {1, 0});
  grid.radius = std::nextafter(5, 6);
  expect_counts(grid, {1, 0});
  grid.radius = 4.999999;
  expect_counts(grid, {1, 36});
}

TEST(Degenerate, CocircularVertices) {
  // Integer points on the circle of radius 65 about the origin; with R = 65 all touch the origin.
  ZoneCase c{{}, 65};
  for (const auto& [x, y] :
       {std::pair{16., 63.}, {25., 60.}, {33., 56.}, {39., 52.}, {52., 39.}, {56., 33.}, {60., 25.}, {63., 16.}})
    for (const int sx : {-1, 1})
      for (const int sy : {-1, 1}) c.parts.push_back(point(sx * x, sy * y));
  SCOPED_TRACE(text(c));
  const Result<Zone> zone = zone_of(c);
  ASSERT_TRUE(zone.ok()) << zone.error().text();
  EXPECT_EQ(fault_in(*zone, c, 0.1).value_or("sound"), "sound");
  EXPECT_EQ(counts(*zone), (RingCounts{1, 0}));
  c.radius = 64.9;
  EXPECT_EQ(fault_in(c, 0.1).value_or("sound"), "sound");
  EXPECT_EQ(counts(*zone_of(c)), (RingCounts{1, 1}));
}

TEST(Degenerate, NearlyEqualVertices) {
  for (double gap = 1e-6; gap > 1e-18; gap /= 8) {
    for (const ZoneCase& c : {
             ZoneCase{{line({{0, 0}, {1, gap}}), line({{0, gap}, {1, 0}})}, 0.5},
             ZoneCase{{line({{0, 0}, {1, 1}, {1 + gap, 1}, {2, 0}})}, 0.5},
             ZoneCase{{line({{0, 0}, {1, 0}}), line({{0.5, gap}, {2, gap}})}, 0.25},
             ZoneCase{{point(0.5, 0.5), point(0.5 + gap, 0.5), point(0.5, 0.5 + gap)}, 0.25},
             ZoneCase{{line({{0, 0}, {1, 0}, {gap, gap}})}, 0.125},
         }) {
      EXPECT_EQ(fault_in(c).value_or("sound"), "sound") << text(c);
      const auto zone = zone_of(c);
      ASSERT_TRUE(zone.ok()) << text(c);
      EXPECT_EQ(counts(*zone), (RingCounts{1, 0})) << text(c);
    }
  }
}

TEST(Degenerate, RadiusFarAboveAndFarBelowTheExtent) {
  const std::vector<Point> zigzag{{0, 0}, {1, 3}, {2, -1}, {2.5, 2}, {4, 0}, {1, -2}, {0, 0}};
  for (int e = -6; e <= 12; ++e) {
    const ZoneCase c{{line(zigzag), point(7, 7)}, std::pow(10.0, e)};
    EXPECT_EQ(fault_in(c, 0.1).value_or("sound"), "sound") << text(c);
  }
}

TEST(Degenerate, FarFromTheOrigin) {
  const std::vector<Point> shape{{0, 0}, {8, 0}, {8, 8}, {0, 8}, {0, 0}, {4, 12}};
  const auto near_zone = zone_of({{line(shape)}, 1});
  ASSERT_TRUE(near_zone.ok());
  for (const double shift : {512345.0, 4.2e6, 1e10}) {
    ZoneCase c{{line(shape)}, 1};
    for (Point& p : c.parts[0].vertices) p.x += shift, p.y += 3 * shift;
    const auto zone = zone_of(c);
    ASSERT_TRUE(zone.ok()) << text(c) << zone.error().text();
    EXPECT_EQ(fault_in(*zone, c, 0.1).value_or("sound"), "sound") << text(c);
    EXPECT_EQ(counts(*zone), counts(*near_zone));
    EXPECT_NEAR(zone->area(), near_zone->area(),
                1e-9 * near_zone->area() + 4e-16 * 3 * shift * near_zone->perimeter() * 32);
  }
}

}  // namespace
}  // namespace krepl::test
