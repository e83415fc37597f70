// Zones of lines and polygons with arcs in other shapes: known areas, and random input, each checked by brute force from
// the definition, to the arcs themselves.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "support/curve_generators.hpp"
#include "support/environment.hpp"
#include "support/zone_generators.hpp"

namespace krepl::test {
namespace {

InputPart circle_ring(double x, double y, double r, std::int64_t feature = 0) {
  return curve_ring({{x + r, y}, {x - r, y}, {x + r, y}}, {1}, feature);
}

ShapeOptions at(double distance, bool ring = false) {
  ShapeOptions o;
  o.distance = distance, o.ring = ring;
  return o;
}

/// The zone, after the verifier has been through it.
Zone checked(const ZoneCase& c, const ShapeOptions& o) {
  auto zone = curve_shape_of(c, o);
  EXPECT_TRUE(zone.ok()) << text(c) << text(o) << ": " << (zone.ok() ? "" : zone.error().text());
  const auto fault = fault_in(*zone, c, o);
  EXPECT_FALSE(fault.has_value()) << text(c) << text(o) << ": " << *fault;
  return std::move(*zone);
}

TEST(CurveShape, ACircleShrinks) {
  const ZoneCase c{{circle_ring(3, 4, 5)}, 1};
  const Zone shrunk = checked(c, at(-2));
  EXPECT_NEAR(shrunk.area(), 9 * M_PI, 1e-11);
  ASSERT_EQ(shrunk.piece_count(), 1u);
  EXPECT_EQ(shrunk.piece(0).radius, 3);
  EXPECT_TRUE(shrunk.piece(0).from_arc);
  EXPECT_EQ(checked(c, at(-5)).ring_count(), 0u);
  EXPECT_EQ(checked(c, at(-6)).ring_count(), 0u);
  EXPECT_NEAR(checked(c, at(-2, true)).area(), 16 * M_PI, 1e-11);
  EXPECT_NEAR(checked(c, at(2, true)).area(), 24 * M_PI, 1e-11);
  EXPECT_EQ(checked(c, at(2, true)).piece_count(), 2u);
}

TEST(CurveShape, AnAnnulusShrinksFromBothSides) {
  const ZoneCase c{{circle_ring(0, 0, 10), circle_ring(0, 0, 4)}, 1};
  const Zone shrunk = checked(c, at(-1));
  EXPECT_NEAR(shrunk.area(), (81 - 25) * M_PI, 1e-10);
  EXPECT_EQ(counts(shrunk), (RingCounts{1, 1}));
  EXPECT_EQ(checked(c, at(-3)).ring_count(), 0u);
  EXPECT_NEAR(checked(c, at(1, true)).area(), (121 - 100 + 16 - 9) * M_PI, 1e-10);
}

/// A dumb-bell of two circles and a narrow bridge splits.
TEST(CurveShape, PolygonsSplitWhereTheyAreNarrow) {
  const double h = 0.5, x = std::sqrt(9 - h * h);
  const ZoneCase c{{curve_ring({{x, -h}, {10 - x, -h}, {13, 0}, {10 - x, h}, {x, h}, {-3, 0}, {x, -h}}, {2, 5})}, 1};
  EXPECT_EQ(counts(checked(c, at(-0.4))), (RingCounts{1, 0}));
  const Zone two = checked(c, at(-1));
  EXPECT_EQ(counts(two), (RingCounts{2, 0}));
  EXPECT_NEAR(two.area(), 2 * 4 * M_PI, 0.05);
  EXPECT_EQ(checked(c, at(-3.1)).ring_count(), 0u);
}

/// The border of two features that share an arc does not show in their ring.
TEST(CurveShape, SharedBordersAreTakenOut) {
  const std::vector<Point> left{{0, 0}, {4, 0}, {5, 2}, {4, 4}, {0, 4}, {0, 0}};
  const std::vector<Point> right{{4, 0}, {9, 0}, {9, 4}, {4, 4}, {5, 2}, {4, 0}};
  const ZoneCase two{{curve_ring(left, {2}, 0), curve_ring(right, {4}, 1)}, 1};
  const Zone ring = checked(two, at(1, true));
  EXPECT_EQ(counts(ring), (RingCounts{1, 1}));
  EXPECT_NEAR(ring.area(), 2 * (9 + 4) + M_PI, 1e-11);
  EXPECT_NEAR(checked(two, at(-1, true)).area(), 36 - checked(two, at(-1)).area(), 1e-10);
  // Of one feature the common side is no border.
  const ZoneCase one{{curve_ring(left, {2}, 0), curve_ring(right, {4}, 0)}, 1};
  EXPECT_NEAR(checked(one, at(-1)).area(), 7 * 2, 1e-11);
  const auto faults = check_rings(*curve_network_of(one));
  ASSERT_EQ(faults->size(), 1u);
  EXPECT_EQ((*faults)[0].kind, RingFault::Kind::overlapping);
}

TEST(CurveShape, FaultsOfRings) {
  const auto faults = [](std::vector<InputPart> parts) { return *check_rings(*curve_network_of({std::move(parts), 1})); };
  EXPECT_TRUE(faults({circle_ring(0, 0, 5)}).empty());
  const auto same_way = faults({circle_ring(0, 0, 5), circle_ring(0, 0, 2)});
  ASSERT_EQ(same_way.size(), 1u);
  EXPECT_EQ(same_way[0].kind, RingFault::Kind::direction);
  const auto crossing = faults({circle_ring(0, 0, 5), circle_ring(6, 0, 5)});
  ASSERT_EQ(crossing.size(), 1u);
  EXPECT_EQ(crossing[0].kind, RingFault::Kind::crossing);
  EXPECT_EQ(crossing[0].count, 2u);
  EXPECT_NEAR(crossing[0].where.x, 3, 1e-12);
}

bool has_lines(const ZoneCase& c) {
  return std::any_of(c.parts.begin(), c.parts.end(), [](const InputPart& p) { return !p.ring; });
}

bool overlaps_itself(const ZoneCase& c) {
  const auto faults = check_rings(*curve_network_of(c));
  return std::any_of(faults->begin(), faults->end(),
                     [](const RingFault& f) { return f.kind == RingFault::Kind::overlapping; });
}

TEST(CurveShapes, ShrunkPolygonsAndRings) {
  std::mt19937_64 random(seed());
  std::size_t empty = 0, split = 0, rings = 0;
  for (int k = 0; k < int(400 * effort()); ++k) {
    ZoneCase c = random_curves(k % 3 == 0 ? CurveFamily::fillets : CurveFamily::arc_rings, random);
    if (has_lines(c)) continue;
    if (k % 2 == 0) c.radius /= 4;
    const ShapeOptions o = at(k % 5 == 4 ? c.radius : -c.radius, k % 5 >= 2);
    SCOPED_TRACE(text(c) + " " + text(o));
    const auto zone = curve_shape_of(c, o);
    if (!zone && zone.error().code == ErrorCode::usage) continue;  // an arc around the whole world
    EXPECT_TRUE(zone.ok()) << zone.error().text();
    if (!zone) continue;
    empty += zone->ring_count() == 0 ? 1 : 0;
    split += zone->polygon_count() > 1 ? 1 : 0;
    rings += o.ring ? 1 : 0;
    // The verifier knows borders that cancel only where they are equal.
    if (overlaps_itself(c)) continue;
    const auto fault = fault_in(*zone, c, o);
    EXPECT_FALSE(fault.has_value()) << *fault;
  }
  std::printf("%zu empty, %zu of several polygons, %zu rings\n", empty, split, rings);
  EXPECT_GT(double(empty), 10 * effort());
  EXPECT_GT(double(split), 10 * effort());
}

/// Rings without arcs come out as those of the engine for segments.
TEST(CurveShapes, WithoutArcsAreThoseOfLines) {
  std::mt19937_64 random(seed() + 1);
  for (int k = 0; k < int(100 * effort()); ++k) {
    std::vector<std::uint8_t> bytes(3 + random() % 40);
    for (auto& b : bytes) b = std::uint8_t(random());
    ZoneCase c = decode(Family::rings, bytes);
    if (has_lines(c)) continue;
    if (k % 2 == 0) c.radius /= 4;
    const ShapeOptions o = at(k % 3 == 0 ? c.radius : -c.radius, k % 3 != 1);
    SCOPED_TRACE(text(c) + " " + text(o));
    // Which sides run along each other is a matter of some 2^-46 of the extent in one engine, of 2^-50 in the other.
    if (overlaps_itself(c)) continue;
    const auto lines = shape_of(c, o), curves = curve_shape_of(c, o);
    ASSERT_TRUE(lines.ok()) << lines.error().text();
    ASSERT_TRUE(curves.ok()) << curves.error().text();
    const double tolerance = std::max(1e-9 * lines->scale(), 64 * lines->network().resolution());
    EXPECT_NEAR(curves->area(), lines->area(), tolerance * (lines->perimeter() + curves->perimeter()));
  }
}

}  // namespace
}  // namespace krepl::test
