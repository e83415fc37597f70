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

TEST(ShapeZones, OneSideOfEveryFamily) {
  std::mt19937_64 random(seed() + 2);
  for (int f = 0; f < int(Family::count); ++f) {
    if (Family(f) == Family::rings || Family(f) == Family::grid_points) continue;
    for (int k = 0; k < int(25 * effort()); ++k) {
      const ZoneCase c = random_case(Family(f), random);
      ShapeOptions o;
      o.distance = c.radius, o.side = k % 2 == 0 ? Side::left : Side::right;
      o.max_error = 1e-6 * c.radius;
      SCOPED_TRACE(text(c) + " " + text(o));
      const auto zone = shape_of(c, o);
      EXPECT_TRUE(zone.ok()) << zone.error().text();
      if (!zone) continue;
      const auto fault = fault_in(*zone, c, o);
      EXPECT_FALSE(fault.has_value()) << *fault;
    }
  }
}

}  // namespace
}  // namespace krepl::test
