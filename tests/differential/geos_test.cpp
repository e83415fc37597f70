// Zones against GEOS: the union of the single segments' buffers, whose chords lie inside the true zone by a known
// depth. (GEOS's buffer of a whole line first simplifies it by R/100, which would hide errors of that size.)
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <random>

#include <geos_c.h>
#include <gtest/gtest.h>

#include "support/environment.hpp"
#include "support/zone_generators.hpp"

namespace krepl::test {
namespace {

constexpr int quadrant_segments = 128;
const double chord_depth = 1 - std::cos(std::numbers::pi / (4 * quadrant_segments));

void ignore(const char*, void*) {}

class Geos {
 public:
  Geos() : handle_(GEOS_init_r()) {
    GEOSContext_setNoticeMessageHandler_r(handle_, ignore, nullptr);
    GEOSContext_setErrorMessageHandler_r(handle_, ignore, nullptr);
  }
  ~Geos() { GEOS_finish_r(handle_); }
  Geos(const Geos&) = delete;
  Geos& operator=(const Geos&) = delete;

  struct Answer {
    RingCounts rings;
    double area = 0;
  };
  /// Nothing where GEOS itself fails.
  std::optional<Answer> zone(const ZoneCase& c) {
    std::vector<GEOSGeometry*> stadiums;
    for (const InputPart& part : c.parts) {
      for (std::size_t i = 0; i < part.vertices.size(); ++i)
        if (i + 1 < part.vertices.size() || part.vertices.size() == 1)
          stadiums.push_back(
              stadium(part.vertices[i], part.vertices[std::min(i + 1, part.vertices.size() - 1)], c.radius));
    }
    GEOSGeometry* all =
        GEOSGeom_createCollection_r(handle_, GEOS_GEOMETRYCOLLECTION, stadiums.data(), unsigned(stadiums.size()));
    GEOSGeometry* dissolved = GEOSUnaryUnion_r(handle_, all);
    GEOSGeom_destroy_r(handle_, all);
    if (dissolved == nullptr) return std::nullopt;
    Answer answer;
    GEOSArea_r(handle_, dissolved, &answer.area);
    for (int i = 0, n = GEOSGetNumGeometries_r(handle_, dissolved); i < n; ++i) {
      ++answer.rings.outer;
      answer.rings.holes += std::size_t(GEOSGetNumInteriorRings_r(handle_, GEOSGetGeometryN_r(handle_, dissolved, i)));
    }
    GEOSGeom_destroy_r(handle_, dissolved);
    return answer;
  }

 private:
  GEOSGeometry* stadium(Point a, Point b, double radius) {
    GEOSGeometry* core;
    if (a == b) {
      core = GEOSGeom_createPointFromXY_r(handle_, a.x, a.y);
    } else {
      GEOSCoordSequence* s = GEOSCoordSeq_create_r(handle_, 2, 2);
      GEOSCoordSeq_setXY_r(handle_, s, 0, a.x, a.y);
      GEOSCoordSeq_setXY_r(handle_, s, 1, b.x, b.y);
      core = GEOSGeom_createLineString_r(handle_, s);
    }
    GEOSGeometry* result = GEOSBuffer_r(handle_, core, radius, quadrant_segments);
    GEOSGeom_destroy_r(handle_, core);
    return result;
  }
  GEOSContextHandle_t handle_;
};

double largest_coordinate(const ZoneCase& c) {
  double largest = 0;
  for (const InputPart& part : c.parts)
    for (const Point& p : part.vertices) largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
  return largest;
}

TEST(AgainstGeos, AreaAndRings) {
  Geos geos;
  std::mt19937_64 random(seed());
  std::size_t compared = 0, rings_compared = 0, refused = 0;
  for (int f = 0; f < int(Family::count); ++f) {
    if (Family(f) == Family::rings) continue;  // no filling in the union of stadiums
    for (int k = 0; k < int(40 * effort()); ++k) {
      std::vector<std::uint8_t> bytes(3 + random() % 50);
      for (auto& b : bytes) b = std::uint8_t(random());
      const ZoneCase c = decode(Family(f), bytes);
      if (c.radius < 1e-8 * largest_coordinate(c)) continue;  // GEOS may drop to 12 digits there
      SCOPED_TRACE(text(c));
      const auto zone = zone_of(c);
      ASSERT_TRUE(zone.ok()) << zone.error().text();
      const auto answer = geos.zone(c);
      if (!answer) {
        ++refused;
        continue;
      }
      ++compared;
      // The chords' zone lies between those of R less the depth and of R; GEOS's own rounding comes on top.
      const double depth = chord_depth * c.radius, rounding = 1e-9 * zone->area();
      EXPECT_GE(zone->area() - answer->area, -rounding);
      EXPECT_LE(zone->area() - answer->area, depth * zone->perimeter() + rounding);
      ZoneCase less = c, more = c;
      less.radius -= 1.01 * depth, more.radius *= 1 + 1e-9;
      const auto inner = zone_of(less), outer = zone_of(more);
      ASSERT_TRUE(inner.ok() && outer.ok());
      if (counts(*inner) == counts(*outer)) {
        ++rings_compared;
        EXPECT_EQ(counts(*zone), answer->rings);
      }
    }
  }
  std::printf("%zu areas and %zu ring counts compared, %zu refused by GEOS\n", compared, rings_compared, refused);
  EXPECT_GT(compared, 10 * refused);
  EXPECT_GT(rings_compared, compared / 3);
}

}  // namespace
}  // namespace krepl::test
