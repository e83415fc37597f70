// Caps, joins and shrunken polygons against GEOS, on single lines of long segments and on stars, where it is right: it
// simplifies its input by a hundredth of the distance, caps every line of a network, and cuts long mitres off at their
// limit, which is left out here.
#include <cmath>
#include <cstdio>
#include <random>

#include <geos_c.h>
#include <gtest/gtest.h>

#include "support/environment.hpp"
#include "support/zone_case.hpp"

namespace krepl::test {
namespace {

constexpr double mitre_limit = 100;

class Geos {
 public:
  Geos() : handle_(GEOS_init_r()) {}
  ~Geos() { GEOS_finish_r(handle_); }
  Geos(const Geos&) = delete;
  Geos& operator=(const Geos&) = delete;

  double area(const InputPart& part, const ShapeOptions& o) {
    const auto n = unsigned(part.vertices.size() + (part.ring ? 1 : 0));
    GEOSCoordSequence* s = GEOSCoordSeq_create_r(handle_, n, 2);
    for (unsigned i = 0; i < n; ++i) {
      const Point p = part.vertices[i % part.vertices.size()];
      GEOSCoordSeq_setXY_r(handle_, s, i, p.x, p.y);
    }
    GEOSGeometry* input = part.ring
                              ? GEOSGeom_createPolygon_r(handle_, GEOSGeom_createLinearRing_r(handle_, s), nullptr, 0)
                              : GEOSGeom_createLineString_r(handle_, s);
    // Both count round, flat, square and round, mitre, bevel from 1.
    GEOSGeometry* zone =
        GEOSBufferWithStyle_r(handle_, input, o.distance, 256, int(o.cap) + 1, int(o.join) + 1, mitre_limit);
    double area = NAN;
    GEOSArea_r(handle_, zone, &area);
    GEOSGeom_destroy_r(handle_, zone);
    GEOSGeom_destroy_r(handle_, input);
    return area;
  }

 private:
  GEOSContextHandle_t handle_;
};

double turn_of(Point a, Point b, Point c) {
  return std::abs(std::remainder(std::atan2(c.y - b.y, c.x - b.x) - std::atan2(b.y - a.y, b.x - a.x), 2 * M_PI));
}

TEST(ShapesAgainstGeos, CapsAndJoinsOfLines) {
  Geos geos;
  std::mt19937_64 random(seed());
  std::size_t compared = 0;
  for (int k = 0; k < int(150 * effort()); ++k) {
    ZoneCase c;
    InputPart part = line({{0, 0}});
    bool gentle = true;
    for (int i = 0; i < 4; ++i) {
      const double angle = 2 * M_PI * double(random() % 1000) / 1000, l = 8 + double(random() % 100) / 10;
      part.vertices.push_back(
          {part.vertices.back().x + l * std::cos(angle), part.vertices.back().y + l * std::sin(angle)});
      if (i > 0)
        gentle = gentle &&
                 turn_of(part.vertices[std::size_t(i) - 1], part.vertices[std::size_t(i)], part.vertices.back()) < 2;
    }
    if (!gentle) continue;
    c.parts = {part};
    ShapeOptions o;
    o.distance = 1, o.cap = Cap(k % 3), o.join = Join(k / 3 % 3), o.mitre_limit = mitre_limit;
    SCOPED_TRACE(text(c) + " " + text(o));
    const auto zone = shape_of(c, o);
    ASSERT_TRUE(zone.ok()) << zone.error().text();
    ++compared;
    EXPECT_NEAR(zone->area(), geos.area(part, o), 1e-3 * zone->area());
  }
  EXPECT_GT(double(compared), 20 * effort());
}

TEST(ShapesAgainstGeos, ShrunkenStars) {
  Geos geos;
  std::mt19937_64 random(seed() + 1);
  for (int k = 0; k < int(100 * effort()); ++k) {
    InputPart star = ring({});
    const int count = 4 + int(random() % 9);
    for (int i = 0; i < count; ++i) {
      const double r = 2 + double(random() % 1000) / 100, angle = 2 * M_PI * i / count;
      star.vertices.push_back({50 + r * std::cos(angle), 50 + r * std::sin(angle)});
    }
    const ZoneCase c{{star}, 1};
    ShapeOptions o;
    o.distance = -0.2 - double(random() % 100) / 50, o.join = Join(k % 3), o.mitre_limit = mitre_limit;
    SCOPED_TRACE(text(c) + " " + text(o));
    const auto zone = shape_of(c, o);
    ASSERT_TRUE(zone.ok()) << zone.error().text();
    EXPECT_NEAR(zone->area(), geos.area(star, o), 0.01 * std::abs(o.distance) * (zone->perimeter() + 1));
  }
}

}  // namespace
}  // namespace krepl::test
