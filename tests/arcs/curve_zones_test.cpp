// Zones of lines with arcs: known areas, and random input of families that are degenerate by design, each checked by
// brute force (distances to the arcs themselves, in extended precision).
#include "krepl/curve_zone.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/curve_generators.hpp"
#include "support/environment.hpp"

namespace krepl::test {
namespace {

Zone zone_of_curves(const ZoneCase& c, unsigned threads = 1) {
  Context context;
  context.threads = threads;
  auto zone = curve_zone_of(c, context);
  EXPECT_TRUE(zone.ok()) << text(c) << ": " << zone.error().text();
  return std::move(zone).value();
}

ZoneCase case_of(std::vector<InputPart> parts, double radius) { return {std::move(parts), radius}; }

InputPart circle(double x, double y, double r) { return curve({{x + r, y}, {x - r, y}, {x + r, y}}, {1}); }

class CurveZones : public testing::TestWithParam<int> {};

/// Random cases of a family, each changed first, are what brute force says.
void expect_sound(CurveFamily family, std::uint64_t first_seed, int cases, ZoneCase (*change)(ZoneCase)) {
  std::mt19937_64 random(first_seed + std::uint64_t(family));
  for (int k = 0; k < cases; ++k) {
    const ZoneCase c = change(random_curves(family, random));
    SCOPED_TRACE(text(c));
    const auto zone = curve_zone_of(c);
    // Three points hardly off a line, the middle not between the others, are an arc around the whole world.
    if (!zone && zone.error().code == ErrorCode::usage) continue;
    ASSERT_TRUE(zone.ok()) << k << ": " << zone.error().text();
    const auto fault = fault_in(*zone, c);
    EXPECT_FALSE(fault.has_value()) << k << ": " << *fault;
  }
}

TEST_P(CurveZones, AreWhatBruteForceSays) {
  expect_sound(CurveFamily(GetParam()), seed(), int(60 * effort()), [](ZoneCase c) { return c; });
}

TEST_P(CurveZones, OfPartsWithRadiiOfTheirOwnAreWhatBruteForceSays) {
  expect_sound(CurveFamily(GetParam()), seed() + 1000, int(40 * effort()), varied);
}

INSTANTIATE_TEST_SUITE_P(Families, CurveZones, testing::Range(0, int(CurveFamily::count)),
                         [](const auto& info) { return name(CurveFamily(info.param)); });

TEST(CurveZone, OfACircleIsARing) {
  for (const double r : {3.0, 1.5, 1.0 + 1e-6, 1.0 + 1e-12}) {
    const Zone zone = zone_of_curves(case_of({circle(10, 20, r)}, 1));
    EXPECT_NEAR(zone.area(), 4 * M_PI * r, 1e-11) << r;
    EXPECT_EQ(zone.hole_count(), r > 1 + 1e-9 ? 1u : 0u);
    EXPECT_EQ(zone.piece_count(), zone.ring_count());  // true circles
    EXPECT_EQ(fault_in(zone, case_of({circle(10, 20, r)}, 1)), std::nullopt);
  }
}

TEST(CurveZone, OfACircleNotWiderThanTheRadiusIsADisk) {
  for (const double r : {1.0, 0.5, 1e-3}) {
    const Zone zone = zone_of_curves(case_of({circle(-3, 7, r)}, 1));
    EXPECT_NEAR(zone.area(), M_PI * (r + 1) * (r + 1), 1e-11) << r;
    EXPECT_EQ(counts(zone), (RingCounts{1, 0}));
    EXPECT_EQ(zone.piece_count(), 1u);
  }
}

TEST(CurveZone, OfARadiusThatIsNoneIsRefused) {
  for (const double radius : {0.0, -1.0, std::nan("")}) {
    const auto zone = curve_zone_of(case_of({circle(0, 0, 3)}, radius));
    ASSERT_FALSE(zone.ok()) << radius;
    EXPECT_EQ(zone.error().code, ErrorCode::usage) << radius;
  }
}

/// A ring of 2 about a circle of 5, and a disk of 4 that reaches into it: the circle's part is a ring of r + 2 and r - 2.
TEST(CurveZone, OfTwoRadiiHasArcsOfBoth) {
  ZoneCase c = case_of({circle(0, 0, 5), point(20, 0)}, 1);
  c.parts[0].radius = 2, c.parts[1].radius = 4;
  const Zone zone = zone_of_curves(c);
  EXPECT_EQ(counts(zone), (RingCounts{2, 1}));
  EXPECT_EQ(zone.radius(), 4);
  EXPECT_EQ(zone.least_radius(), 2);
  EXPECT_NEAR(zone.area(), M_PI * (49 - 9 + 16), 1e-11);
  EXPECT_EQ(fault_in(zone, c), std::nullopt);
  c.parts[1].vertices[0].x = 8;
  const Zone one = zone_of_curves(c);
  EXPECT_EQ(one.polygon_count(), 1u);
  EXPECT_EQ(fault_in(one, c), std::nullopt);
  const auto network = std::make_shared<const CurveNetwork>(*curve_network_of(c));
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) EXPECT_FALSE(compute_zone(network, std::vector<double>{1, bad}).ok()) << bad;
  EXPECT_FALSE(compute_zone(network, std::vector<double>{1}).ok());
}

TEST(CurveZone, OfAStadium) {
  // Two straights of 4 and two half circles of radius 2, as one closed line, then filled.
  const std::vector<Point> track{{0, 0}, {4, 0}, {6, 2}, {4, 4}, {0, 4}, {-2, 2}, {0, 0}};
  const Zone line = zone_of_curves(case_of({curve(track, {2, 5})}, 0.5));
  EXPECT_NEAR(line.area(), 1.0 * (8 + 4 * M_PI), 1e-11);
  EXPECT_EQ(line.piece_count(), 8u);
  const Zone filled = zone_of_curves(case_of({curve_ring(track, {2, 5})}, 0.5));
  EXPECT_NEAR(filled.area(), 4 * 5 + M_PI * 2.5 * 2.5, 1e-11);
  EXPECT_EQ(filled.piece_count(), 4u);
}

TEST(CurveZone, OfAnArcTellsItsPieces) {
  const ZoneCase c = case_of({curve({{2, 0}, {0, 2}, {-2, 0}}, {1})}, 0.5);
  const Zone zone = zone_of_curves(c);
  ASSERT_EQ(zone.piece_count(), 4u);
  EXPECT_NEAR(zone.area(), 2 * M_PI + M_PI / 4, 1e-12);
  ASSERT_NE(zone.curves(), nullptr);
  std::size_t outer = 0, inner = 0, caps = 0;
  for (std::uint32_t e = 0; e < 4; ++e) {
    const Zone::Piece p = zone.piece(e);
    EXPECT_EQ(p.kind, Zone::Kind::arc);
    outer += p.from_arc && !p.clockwise && p.radius == 2.5;
    inner += p.from_arc && p.clockwise && p.radius == 1.5;
    caps += p.from_vertex && p.radius == 0.5;
    if (p.from_arc) {
      EXPECT_EQ(zone.curves()->arc_source(p.source).vertex, 0u);
    }
  }
  EXPECT_EQ(outer, 1u);
  EXPECT_EQ(inner, 1u);
  EXPECT_EQ(caps, 2u);
}

}  // namespace
}  // namespace krepl::test
