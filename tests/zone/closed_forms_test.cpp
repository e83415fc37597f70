// Zones whose rings and areas are known in closed form.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/zone_case.hpp"

namespace krepl::test {
namespace {

using std::numbers::pi;

/// Area common to two disks of radius r whose centres are d apart.
double lens(double r, double d) { return 2 * r * r * std::acos(d / (2 * r)) - d / 2 * std::sqrt(4 * r * r - d * d); }

void expect_zone(const ZoneCase& c, RingCounts rings, double area) {
  SCOPED_TRACE(text(c));
  const Result<Zone> zone = zone_of(c);
  ASSERT_TRUE(zone.ok()) << zone.error().text();
  EXPECT_EQ(fault_in(*zone, c, 0.1).value_or("sound"), "sound");
  EXPECT_EQ(counts(*zone), rings);
  EXPECT_NEAR(zone->area(), area, 1e-12 * area);
}

/// Corners of a regular polygon about (0,0).
std::vector<Point> regular(int n, double circumradius, bool closed) {
  std::vector<Point> v;
  for (int k = 0; k < n; ++k)
    v.push_back({circumradius * std::cos(2 * pi * k / n), circumradius * std::sin(2 * pi * k / n)});
  if (closed) v.push_back(v[0]);
  return v;
}

TEST(ClosedForms, PointIsADisk) {
  expect_zone({{point(3, 4)}, 2}, {1, 0}, 4 * pi);
  expect_zone({{point(0, 0)}, 1e-6}, {1, 0}, 1e-12 * pi);
  expect_zone({{point(-7, 1)}, 1e6}, {1, 0}, 1e12 * pi);
}

TEST(ClosedForms, TwoPoints) {
  expect_zone({{point(0, 0), point(3, 0)}, 1}, {2, 0}, 2 * pi);
  expect_zone({{point(0, 0), point(1.5, 0)}, 1}, {1, 0}, 2 * pi - lens(1, 1.5));
  expect_zone({{point(0, 0), point(0, 1e-3)}, 1}, {1, 0}, 2 * pi - lens(1, 1e-3));
}

TEST(ClosedForms, ThreePointsAroundAHole) {
  const double s = 1.8, h = s * std::sqrt(3.0) / 2;
  expect_zone({{point(0, 0), point(s, 0), point(s / 2, h)}, 1}, {1, 1}, 3 * pi - 3 * lens(1, s));
}

TEST(ClosedForms, SegmentIsAStadium) {
  for (const double r : {1e-3, 1.0, 1e3}) {
    expect_zone({{line({{0, 0}, {3, 4}})}, r}, {1, 0}, 2 * 5 * r + pi * r * r);
    expect_zone({{line({{-1, 7}, {5, 7}})}, r}, {1, 0}, 2 * 6 * r + pi * r * r);
    expect_zone({{line({{2, 9}, {2, 1}})}, r}, {1, 0}, 2 * 8 * r + pi * r * r);
  }
}

TEST(ClosedForms, RightAngle) {
  // Two stadiums less what they share: a square inside the angle and three quarters of the disk.
  expect_zone({{line({{-5, 0}, {0, 0}, {0, 5}})}, 1}, {1, 0}, 4 * 5 + 2 * pi - 0.75 * pi - 1);
}

TEST(ClosedForms, Crossing) {
  expect_zone({{line({{-4, 0}, {4, 0}}), line({{0, -4}, {0, 4}})}, 1}, {1, 0}, 2 * (16 + pi) - 4);
  // At 3-4-5 the strips share a rhombus of height 2R and area 4 R^2 / sin.
  const double sine = 24.0 / 25;
  expect_zone({{line({{-30, -40}, {30, 40}}), line({{-40, -30}, {40, 30}})}, 1}, {1, 0},
              2 * (200 + pi) - 4 / (7.0 / 25));
  expect_zone({{line({{-30, -40}, {30, 40}}), line({{-30, 40}, {30, -40}})}, 1}, {1, 0}, 2 * (200 + pi) - 4 / sine);
}

TEST(ClosedForms, TeeAndStar) {
  expect_zone({{line({{-5, 0}, {5, 0}}), line({{0, 0}, {0, 6}})}, 1}, {1, 0}, 20 + pi + 2 * 5 + pi / 2);
  // n rays from a point: each owns the wedge between its bisectors, where its strip is first a triangle, then a
  // rectangle.
  for (const int n : {3, 4, 6, 8, 16}) {
    ZoneCase c{{}, 1};
    const double length = 20;
    for (const Point& p : regular(n, length, false)) c.parts.push_back(line({{0, 0}, p}));
    const double inner = 1 / std::tan(pi / n);
    expect_zone(c, {1, 0}, n * (2 * (length - inner) + inner + pi / 2));
  }
}

TEST(ClosedForms, ClosedSquare) {
  const std::vector<Point> square{{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}};
  const double outer = 100 + 40 + pi;
  expect_zone({{line(square)}, 1}, {1, 1}, outer - 64);
  expect_zone({{line(square)}, 4.999}, {1, 1}, 100 + 40 * 4.999 + pi * 4.999 * 4.999 - 0.002 * 0.002);
  expect_zone({{line(square)}, 5.001}, {1, 0}, 100 + 40 * 5.001 + pi * 5.001 * 5.001);
  expect_zone({{ring(square)}, 1}, {1, 0}, outer);
  expect_zone({{line(square)}, 100}, {1, 0}, 100 + 4000 + pi * 1e4);
}

TEST(ClosedForms, PolygonsAreFilledByTheEvenOddRule) {
  const std::vector<Point> outer{{0, 0}, {20, 0}, {20, 20}, {0, 20}}, hole{{5, 5}, {15, 5}, {15, 15}, {5, 15}},
      island{{9, 9}, {11, 9}, {11, 11}, {9, 11}};
  const double whole = 400 + 80 + pi;
  expect_zone({{ring(outer), ring(hole)}, 1}, {1, 1}, whole - 64);
  expect_zone({{ring(hole), ring(outer)}, 1}, {1, 1}, whole - 64);
  expect_zone({{ring(outer), ring(hole), ring(island)}, 1}, {2, 1}, whole - 64 + 4 + 8 + pi);
  // The island's zone just touches the hole's four sides: what touches is one, and four corners stay.
  expect_zone({{ring(outer), ring(hole), ring(island)}, 2}, {1, 4}, 400 + 160 + 4 * pi - 4 * (4 - pi));
}

TEST(ClosedForms, RegularPolygonLine) {
  for (const int n : {3, 5, 7, 12, 100}) {
    const double circumradius = 10, side = 2 * circumradius * std::sin(pi / n),
                 apothem = circumradius * std::cos(pi / n);
    const double area = n * side * apothem / 2;
    for (const double r : {0.01, 1.0, 0.9 * apothem}) {
      const double shrink = (apothem - r) / apothem;
      expect_zone({{line(regular(n, circumradius, true))}, r}, {1, 1},
                  area + n * side * r + pi * r * r - area * shrink * shrink);
    }
    expect_zone({{line(regular(n, circumradius, true))}, 1.1 * apothem}, {1, 0},
                area + n * side * 1.1 * apothem + pi * 1.21 * apothem * apothem);
  }
}

TEST(ClosedForms, NestedRings) {
  ZoneCase c{{}, 1};
  double area = 0;
  for (int k = 1; k <= 6; ++k) {
    const double a = 10.0 * k;
    c.parts.push_back(line({{-a, -a}, {a, -a}, {a, a}, {-a, a}, {-a, -a}}));
    area += 4 * a * a + 8 * a + pi - 4 * (a - 1) * (a - 1);
  }
  expect_zone(c, {6, 6}, area);
}

TEST(ClosedForms, GridOfStreets) {
  ZoneCase c{{}, 1};
  const int n = 8;
  const double block = 10, size = n * block;
  for (int k = 0; k <= n; ++k) {
    c.parts.push_back(line({{0, k * block}, {size, k * block}}));
    c.parts.push_back(line({{k * block, 0}, {k * block, size}}));
  }
  expect_zone(c, {1, n * n}, size * size + 4 * size + pi - n * n * 64);
}

}  // namespace
}  // namespace krepl::test
