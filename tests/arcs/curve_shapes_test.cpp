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

/// Known areas, each also by a formula.
TEST(CurveShape, CapsAndJoins) {
  const auto area = [](const InputPart& part, Cap cap, Join join = Join::round, double radius = 1) {
    ShapeOptions o;
    o.distance = radius, o.cap = cap, o.join = join;
    return checked({{part}, radius}, o).area();
  };
  const InputPart half = curve({{5, 0}, {0, 5}, {-5, 0}}, {1});
  EXPECT_NEAR(area(half, Cap::flat), 10 * M_PI, 1e-10);
  EXPECT_NEAR(area(half, Cap::square), 10 * M_PI + 4, 1e-10);
  EXPECT_NEAR(area(half, Cap::round, Join::mitre), 11 * M_PI, 1e-10);
  EXPECT_NEAR(area(half, Cap::flat, Join::round, 6), (121 + 1) * M_PI / 2, 1e-10);  // also beyond the centre
  // A half circle and a line that leaves it at a right angle, outwards.
  const InputPart corner = curve({{5, 0}, {0, 5}, {-5, 0}, {-15, 0}}, {1});
  const double straight = 10 * M_PI + 20;
  // The corner of side 1 is there twice, less what is between the arc of 4 or 6 and its tangent.
  const double twice = area(corner, Cap::flat, Join::bevel);
  EXPECT_NEAR(area(corner, Cap::flat, Join::mitre), twice + 0.5, 1e-10);
  EXPECT_NEAR(area(corner, Cap::flat, Join::round), twice + M_PI / 4 - 0.5, 1e-10);
  EXPECT_LT(twice, straight);
  EXPECT_NEAR(area(corner, Cap::square, Join::bevel), twice + 4, 1e-10);
  // Where a line runs smoothly into an arc nothing shows of the joint.
  const InputPart smooth = curve({{-4, 0}, {0, 0}, {3, 3}, {0, 6}, {-4, 6}}, {2});
  for (const Join join : {Join::round, Join::bevel, Join::mitre})
    EXPECT_NEAR(area(smooth, Cap::flat, join), 2 * (8 + 3 * M_PI), 1e-10);
}

/// Two arcs over one chord that differ by less than 1e-10 of the coordinates turn back into each other, and pieces of their
/// zone are all but parallel.
TEST(CurveShape, FlatArcsOverOneChord) {
  ShapeOptions o;
  o.distance = 1, o.cap = Cap::square, o.join = Join::mitre, o.mitre_limit = 1.375;
  const double side = 2 * std::sqrt(8.0);
  const Zone far = checked({{curve({{400962, 5400002}, {400962.70537349756, 5400001.2946026158}, {400964, 5400000}}, {1}),
                             curve({{400964, 5400000}, {400962.92770613194, 5400001.0722938683}, {400962, 5400002}}, {1})},
                            1},
                           o);
  EXPECT_NEAR(far.area(), side, 1e-3);
  const Zone near = checked({{curve({{-2, 2}, {-1.0001, 0.9999}, {0, 0}}, {1}), curve({{0, 0}, {-1.000000001, 0.999999999}, {-2, 2}}, {1})}, 1}, o);
  EXPECT_NEAR(near.area(), side, 1e-3);
}

TEST(CurveShapes, CapsAndJoinsOfEveryFamily) {
  std::mt19937_64 random(seed() + 2);
  for (int f = 0; f < int(CurveFamily::count); ++f) {
    for (int k = 0; k < int(25 * effort()); ++k) {
      const ZoneCase c = random_curves(CurveFamily(f), random);
      ShapeOptions o = at(c.radius);
      do {
        o.cap = Cap(random() % 3), o.join = Join(random() % 3);
      } while (o.cap == Cap::round && o.join == Join::round);
      o.mitre_limit = 1 + double(random() % 40) / 8;
      SCOPED_TRACE(std::string(name(CurveFamily(f))) + ": " + text(c) + " " + text(o));
      const auto zone = curve_shape_of(c, o);
      if (!zone && zone.error().code == ErrorCode::usage) continue;  // an arc around the whole world
      EXPECT_TRUE(zone.ok()) << zone.error().text();
      if (!zone) continue;
      const auto fault = fault_in(*zone, c, o);
      EXPECT_FALSE(fault.has_value()) << *fault;
    }
  }
}

/// Caps and joins without arcs are those of the engine for segments.
TEST(CurveShapes, CapsAndJoinsOfLinesAreThoseOfLines) {
  std::mt19937_64 random(seed() + 3);
  for (int f = 0; f < int(Family::count); ++f) {
    for (int k = 0; k < int(12 * effort()); ++k) {
      std::vector<std::uint8_t> bytes(3 + random() % 40);
      for (auto& b : bytes) b = std::uint8_t(random());
      const ZoneCase c = decode(Family(f), bytes);
      ShapeOptions o = at(c.radius);
      o.cap = Cap(random() % 3), o.join = Join(1 + random() % 2);
      SCOPED_TRACE(text(c) + " " + text(o));
      const auto lines = shape_of(c, o), curves = curve_shape_of(c, o);
      ASSERT_EQ(lines.ok(), curves.ok()) << (curves.ok() ? lines : curves).error().text();
      if (!lines) continue;
      const double tolerance = std::max(1e-9 * lines->scale(), 64 * lines->network().resolution());
      EXPECT_NEAR(curves->area(), lines->area(), tolerance * (lines->perimeter() + curves->perimeter()));
    }
  }
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
