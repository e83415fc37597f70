// Zones whose parts have radii of their own: closed forms, degenerate meetings of unequal disks and cigars, and random
// input of all families against brute force.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/zone_property.hpp"

namespace krepl::test {
namespace {

constexpr double pi = std::numbers::pi;

InputPart with(InputPart part, double radius) {
  part.radius = radius;
  return part;
}

Zone sound_zone(const ZoneCase& c) {
  Result<Zone> zone = zone_of(c);
  EXPECT_TRUE(zone.ok()) << (zone.ok() ? "" : zone.error().text()) << '\n' << text(c);
  if (!zone.ok()) return {};
  const auto fault = fault_in(*zone, c, 0.05);
  EXPECT_FALSE(fault) << *fault << '\n' << text(c);
  return std::move(zone).value();
}

TEST(VariedRadii, TwoDisksApart) {
  const Zone zone = sound_zone({{with(point(0, 0), 1), with(point(10, 0), 2)}});
  EXPECT_EQ(counts(zone), (RingCounts{2, 0}));
  EXPECT_NEAR(zone.area(), 5 * pi, 1e-12);
  EXPECT_EQ(zone.radius(), 2);
  EXPECT_EQ(zone.least_radius(), 1);
}

TEST(VariedRadii, LensOfTwoDisks) {
  const double r = 3, s = 5, d = 6;
  const Zone zone = sound_zone({{with(point(0, 0), r), with(point(d, 0), s)}});
  const double a = std::acos((d * d + r * r - s * s) / (2 * d * r)), b = std::acos((d * d + s * s - r * r) / (2 * d * s));
  const double lens = r * r * (a - std::sin(2 * a) / 2) + s * s * (b - std::sin(2 * b) / 2);
  EXPECT_EQ(counts(zone), (RingCounts{1, 0}));
  EXPECT_NEAR(zone.area(), pi * (r * r + s * s) - lens, 1e-12);
}

TEST(VariedRadii, TheSmallerDiskVanishesInTheLarger) {
  for (const double x : {0.0, 0.5, 1.0}) {  // concentric, inside, touching from inside
    const Zone zone = sound_zone({{with(point(0, 0), 2), with(point(x, 0), 1)}});
    EXPECT_EQ(counts(zone), (RingCounts{1, 0})) << x;
    EXPECT_NEAR(zone.area(), 4 * pi, 1e-9) << x;
  }
}

TEST(VariedRadii, DisksThatTouchMerge) {
  const Zone zone = sound_zone({{with(point(0, 0), 2), with(point(3, 0), 1)}});
  EXPECT_EQ(counts(zone), (RingCounts{1, 0}));
  EXPECT_NEAR(zone.area(), 5 * pi, 1e-6);
}

TEST(VariedRadii, OneLineTwiceCountsWithItsLargerRadius) {
  const auto l = line({{0, 0}, {10, 0}, {10, 7}});
  const Zone twice = sound_zone({{with(l, 1), with(l, 3)}}), once = sound_zone({{l}, 3});
  EXPECT_EQ(twice.piece_count(), once.piece_count());
  EXPECT_DOUBLE_EQ(twice.area(), once.area());
}

TEST(VariedRadii, ALineNarrowsAtASharedVertex) {
  // Collinear, and at several angles; the joint shows the larger half disk.
  const Zone straight = sound_zone({{with(line({{0, 0}, {10, 0}}), 1), with(line({{10, 0}, {30, 0}}), 4)}});
  EXPECT_EQ(counts(straight), (RingCounts{1, 0}));
  // Outside the large disk: the thin one's left half disk and the strip up to the circle.
  const double thin = pi / 2 + 20 - (std::sqrt(15.0) + 16 * std::asin(0.25));
  EXPECT_NEAR(straight.area(), 160 + 16 * pi + thin, 1e-11);
  for (const Point p : {Point{20, 10}, {0, 10}, {10, 10}, {0, 0.5}, {3, 0}})
    sound_zone({{with(line({{0, 0}, {10, 0}}), 1), with(line({{10, 0}, p}), 4)}});
}

TEST(VariedRadii, AThinCigarPiercesALargeDisk) {
  // Comes out on both sides: the circle is covered in two stretches.
  const Zone zone = sound_zone({{with(point(0, 0), 5), with(line({{-20, 0}, {20, 0}}), 1)}});
  const double half = std::asin(0.2);
  EXPECT_EQ(counts(zone), (RingCounts{1, 0}));
  EXPECT_EQ(zone.piece_count(), 8u);
  const double inside = 25 * 2 * half / 2 * 2 + 2 * 5 * std::cos(half);  // of the strip, within the disk
  EXPECT_NEAR(zone.area(), 25 * pi + 80 + pi - inside, 1e-11);
}

TEST(VariedRadii, CigarsInsideADisk) {
  sound_zone({{with(point(0, 0), 5), with(line({{-2, 1}, {2, 1}}), 1)}});
  sound_zone({{with(point(0, 0), 5), with(line({{-4, 0}, {4, 0}}), 1)}});   // touches at both ends
  sound_zone({{with(point(0, 0), 5), with(line({{-4, 0}, {4.5, 0}}), 1)}});
  sound_zone({{with(point(0, 0), 5), with(line({{0, 0}, {4, 3}}), 2)}});    // starts at the centre
  sound_zone({{with(point(0, 0), 5), with(line({{-9, 4}, {9, 4}}), 1)}});   // its side touches the disk
  sound_zone({{with(point(0, 0), 5), with(line({{-9, 6}, {9, 6}}), 1)}});   // touches from outside
  sound_zone({{with(point(0, 0), 1), with(line({{-9, 3}, {9, 3}}), 4)}});   // the disk touches its side from inside
}

TEST(VariedRadii, PolygonsAreFilled) {
  const Zone zone = sound_zone({{with(ring({{0, 0}, {20, 0}, {20, 20}, {0, 20}}, 1), 1),
                                 with(ring({{5, 5}, {15, 5}, {15, 15}, {5, 15}}, 1), 1), with(point(10, 10), 2)}});
  EXPECT_EQ(counts(zone), (RingCounts{2, 1}));
  EXPECT_NEAR(zone.area(), 22 * 22 - (4 - pi) - 64 + 4 * pi, 1e-10);
}

TEST(VariedRadii, EqualRadiiGiveTheSameBits) {
  std::vector<InputPart> parts{line({{0, 0}, {9, 1}, {4, 6}}), line({{2, 5}, {8, -3}}), point(7, 7)};
  const ZoneCase one{parts, 1.3};
  for (InputPart& part : parts) part.radius = 1.3;
  const Zone a = sound_zone(one), b = sound_zone({parts, 0});
  ASSERT_EQ(a.piece_count(), b.piece_count());
  for (std::uint32_t e = 0; e < a.piece_count(); ++e) {
    EXPECT_EQ(a.piece(e).start, b.piece(e).start);
    EXPECT_EQ(a.piece(e).source, b.piece(e).source);
  }
}

TEST(VariedRadii, BadRadiiAreRefused) {
  const auto network = std::make_shared<const Network>(*network_of({{point(0, 0), point(9, 0)}}));
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_FALSE(compute_zone(network, std::vector<double>{1, bad}).ok()) << bad;
    EXPECT_FALSE(compute_zone(network, std::vector<double>{bad, 1}).ok()) << bad;
  }
  EXPECT_FALSE(compute_zone(network, std::vector<double>{1}).ok());
}

class VariedRadiiOfAllFamilies : public PropertyTest {};

TEST_P(VariedRadiiOfAllFamilies, PassTheVerifier) {
  holds("sound", [](const ZoneCase& given) {
    const ZoneCase c = varied(given);
    const auto fault = fault_in(c);
    if (fault) RC_LOG() << text(c) << '\n' << *fault << '\n';
    RC_ASSERT(!fault);
  });
}

KREPL_FOR_ALL_FAMILIES(VariedRadiiOfAllFamilies);

}  // namespace
}  // namespace krepl::test
