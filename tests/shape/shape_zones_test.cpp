// Zones of other shapes on random input of all families, each checked by brute force from the definition.
#include "krepl/shape.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include "support/environment.hpp"
#include "support/zone_generators.hpp"

namespace krepl::test {
namespace {

ZoneCase random_case(Family family, std::mt19937_64& random) {
  std::vector<std::uint8_t> bytes(3 + random() % 40);
  for (auto& b : bytes) b = std::uint8_t(random());
  return decode(family, bytes);
}

bool has_lines(const ZoneCase& c) {
  return std::any_of(c.parts.begin(), c.parts.end(), [](const InputPart& p) { return !p.ring; });
}

bool overlaps_itself(const ZoneCase& c) {
  const auto network = network_of(c);
  const auto faults = check_rings(*network);
  return std::any_of(faults->begin(), faults->end(),
                     [](const RingFault& f) { return f.kind == RingFault::Kind::overlapping; });
}

TEST(ShapeZones, CapsAndJoinsOfEveryFamily) {
  std::mt19937_64 random(seed());
  for (int f = 0; f < int(Family::count); ++f) {
    for (int k = 0; k < int(25 * effort()); ++k) {
      const ZoneCase c = random_case(Family(f), random);
      ShapeOptions o;
      o.distance = c.radius;
      do {
        o.cap = Cap(random() % 3), o.join = Join(random() % 3);
      } while (o.cap == Cap::round && o.join == Join::round);
      o.mitre_limit = 1 + double(random() % 40) / 8;
      SCOPED_TRACE(text(c) + " " + text(o));
      const auto zone = shape_of(c, o);
      EXPECT_TRUE(zone.ok()) << zone.error().text();
      if (!zone) continue;
      const auto fault = fault_in(*zone, c, o);
      EXPECT_FALSE(fault.has_value()) << *fault;
    }
  }
}

TEST(ShapeZones, ShrunkPolygonsAndRings) {
  std::mt19937_64 random(seed() + 1);
  std::size_t empty = 0, split = 0;
  for (int k = 0; k < int(200 * effort()); ++k) {
    ZoneCase c = random_case(Family::rings, random);
    if (has_lines(c)) continue;
    // Shrinking by much leaves nothing most of the time.
    if (k % 2 == 0) c.radius /= 4;
    ShapeOptions o;
    o.join = k % 3 == 0 ? Join(random() % 3) : Join::round;
    o.ring = k % 4 >= 2;
    o.distance = k % 5 == 4 && o.ring ? c.radius : -c.radius;
    SCOPED_TRACE(text(c) + " " + text(o));
    const auto zone = shape_of(c, o);
    EXPECT_TRUE(zone.ok()) << zone.error().text();
    if (!zone) continue;
    empty += zone->ring_count() == 0 ? 1 : 0;
    split += zone->polygon_count() > 1 ? 1 : 0;
    // The verifier knows borders that cancel only where they are equal.
    if (overlaps_itself(c)) continue;
    const auto fault = fault_in(*zone, c, o);
    EXPECT_FALSE(fault.has_value()) << *fault;
  }
  std::printf("%zu empty, %zu of several polygons\n", empty, split);
  EXPECT_GT(double(empty), 10 * effort());
  EXPECT_GT(double(split), 10 * effort());
}

/// A vertex on another segment, or nearly: where lines lie on each other rounding decides whose side is nearest.
bool has_touching_lines(const ZoneCase& c) {
  const verify::Obstacle obstacle(c.parts);
  const long double near = 1e-8L * std::max<long double>(obstacle.extent(), c.radius);
  for (const auto& s : obstacle.segments().items())
    for (const auto& v : obstacle.vertices().items())
      if (!(v.at == s.a) && !(v.at == s.b) && s.distance(v.at) < near) return true;
  return false;
}

TEST(ShapeZones, OneSideOfEveryFamily) {
  std::mt19937_64 random(seed() + 2);
  std::size_t checked = 0;
  for (int f = 0; f < int(Family::count); ++f) {
    if (Family(f) == Family::rings || Family(f) == Family::grid_points) continue;
    for (int k = 0; k < int(12 * effort()); ++k) {
      const ZoneCase c = random_case(Family(f), random);
      ShapeOptions o;
      o.distance = c.radius, o.side = k % 2 == 0 ? Side::left : Side::right;
      o.join = Join(k / 2 % 3);
      o.mitre_limit = 1 + double(random() % 40) / 8;
      o.max_error = 1e-4 * c.radius;
      SCOPED_TRACE(text(c) + " " + text(o));
      const auto zone = shape_of(c, o);
      EXPECT_TRUE(zone.ok()) << zone.error().text();
      if (!zone || has_touching_lines(c)) continue;
      ++checked;
      const auto fault = fault_in(*zone, c, o);
      EXPECT_FALSE(fault.has_value()) << *fault;
    }
  }
  std::printf("%zu checked\n", checked);
  EXPECT_GT(double(checked), 20 * effort());
}

/// Known areas, each also by a formula.
TEST(ShapeZones, KnownAreas) {
  const ZoneCase corner{{line({{0, 0}, {10, 0}, {10, 10}})}, 1};
  const auto area = [&](Cap cap, Join join, double limit = 5) {
    ShapeOptions o;
    o.distance = 1, o.cap = cap, o.join = join, o.mitre_limit = limit;
    return shape_of(corner, o)->area();
  };
  EXPECT_NEAR(area(Cap::flat, Join::mitre), 40, 1e-12);
  EXPECT_NEAR(area(Cap::flat, Join::bevel), 39.5, 1e-12);
  EXPECT_NEAR(area(Cap::flat, Join::mitre, 1.4), 39.5, 1e-12);
  EXPECT_NEAR(area(Cap::square, Join::mitre), 44, 1e-12);
  EXPECT_NEAR(area(Cap::round, Join::mitre), 40 + M_PI, 1e-12);
  const auto one_side = [&](Side side, Join join, double limit = 5) {
    ShapeOptions o;
    o.distance = 1, o.side = side, o.join = join, o.mitre_limit = limit;
    return shape_of(corner, o)->area();
  };
  EXPECT_NEAR(one_side(Side::right, Join::round), 20 + M_PI / 4, 1e-12);
  EXPECT_NEAR(one_side(Side::right, Join::mitre), 21, 1e-12);
  EXPECT_NEAR(one_side(Side::right, Join::bevel), 20.5, 1e-12);
  EXPECT_NEAR(one_side(Side::right, Join::mitre, 1.4), 20.5, 1e-12);
  EXPECT_NEAR(one_side(Side::left, Join::mitre), 19, 1e-12);
}

/// A mitre's tip ends half-way to another line, and is one piece with the offset that it prolongs.
TEST(ShapeZones, MitresOfOneSideMeetOtherLines) {
  const auto near = line({{12, -3}, {12, 3}});
  const ZoneCase c{{line({{0, 0}, {10, 0}, {0, 5}}), near}, 3};
  for (const Side side : {Side::left, Side::right}) {
    for (const Join join : {Join::mitre, Join::bevel}) {
      ShapeOptions o;
      o.distance = c.radius, o.side = side, o.join = join, o.max_error = 1e-4 * c.radius;
      const auto zone = shape_of(c, o);
      ASSERT_TRUE(zone.ok()) << zone.error().text();
      const auto fault = fault_in(*zone, c, o);
      EXPECT_FALSE(fault.has_value()) << *fault;
    }
  }
  const ZoneCase alone{{line({{0, 0}, {10, 0}, {10, 10}})}, 1};
  ShapeOptions o;
  o.distance = 1, o.side = Side::right, o.join = Join::mitre;
  EXPECT_EQ(shape_of(alone, o)->piece_count(), 6u);
}

/// The definition is tested too: a zone of another shape is found out.
TEST(ShapeZones, WrongShapesAreFound) {
  const ZoneCase corner{{line({{0, 0}, {10, 0}, {10, 10}})}, 1};
  ShapeOptions flat;
  flat.distance = 1, flat.cap = Cap::flat;
  const auto zone = shape_of(corner, flat);
  EXPECT_FALSE(fault_in(*zone, corner, flat).has_value());
  for (int k = 0; k < 4; ++k) {
    ShapeOptions other = flat;
    if (k == 0) other.cap = Cap::square;
    if (k == 1) other.join = Join::mitre;
    if (k == 2) other.join = Join::bevel;
    if (k == 3) other.distance = 1.001;
    EXPECT_TRUE(fault_in(*zone, corner, other, 0.1).has_value()) << k;
  }
}

/// A hole's leftmost place is as high as the place where its polygon touches another.
TEST(ShapeZones, HolesOfPolygonsThatTouch) {
  const ZoneCase two{{ring({{0, 0}, {1, -1}, {2, 0}, {1, 1}}, 0), ring({{2, 0}, {3, -1}, {4, 0}, {3, 1}}, 1)}, 0.25};
  ShapeOptions o;
  o.distance = -0.25, o.ring = true;
  const auto zone = shape_of(two, o);
  ASSERT_TRUE(zone.ok());
  EXPECT_EQ(counts(*zone), (RingCounts{2, 2}));
  const auto fault = fault_in(*zone, two, o);
  EXPECT_FALSE(fault.has_value()) << *fault;
  for (std::uint32_t p = 0; p < 2; ++p) EXPECT_EQ(zone->polygon(p).holes.size(), 1u);
}

/// With the defaults it is compute_zone, bit for bit.
TEST(ShapeZones, DefaultsAreTheRoundZone) {
  const ZoneCase corner{{line({{0, 0}, {10, 0.1}, {10, 10}}), point(3, 30)}, 1.3};
  ShapeOptions o;
  o.distance = corner.radius;
  const auto shape = shape_of(corner, o), round = zone_of(corner);
  ASSERT_EQ(shape->piece_count(), round->piece_count());
  for (std::uint32_t e = 0; e < round->piece_count(); ++e) EXPECT_EQ(shape->piece(e).start, round->piece(e).start);
}

}  // namespace
}  // namespace krepl::test
