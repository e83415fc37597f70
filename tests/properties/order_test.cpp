// The zone depends on the point set only, grows with it and with R, and holds it.
#include <algorithm>
#include <cmath>
#include <random>

#include "support/environment.hpp"
#include "support/zone_property.hpp"
#include "verify/boundary.hpp"

namespace krepl::test {
namespace {

using verify::Boundary;
using verify::Obstacle;
using verify::Vec;

void assert_same(const ZoneCase& c, const ZoneCase& d) {
  RC_LOG() << "written as " << text(d) << '\n';
  const auto a = zone_of(c), b = zone_of(d);
  RC_ASSERT(a.ok());
  RC_ASSERT(b.ok());
  RC_ASSERT(counts(*a) == counts(*b));
  RC_ASSERT(std::abs(a->area() - b->area()) <= 1e-13 * a->area() + 1e-15 * a->scale() * a->perimeter());
}

double tolerance(const Zone& zone, const Obstacle& obstacle) {
  return std::max(1e-9 * zone.scale(), 64 * double(obstacle.resolution()));
}

/// Every point of the inner zone's boundary lies in the outer zone, or within `slack` of its boundary.
void assert_inside(const Zone& inner, const Obstacle& inner_input, const Zone& outer, const Obstacle& outer_input,
                   double slack) {
  const Boundary a(plain(inner), inner_input, {inner.radius(), tolerance(inner, inner_input)});
  const Boundary b(plain(outer), outer_input, {outer.radius(), tolerance(outer, outer_input)});
  for (const auto& curve : a.curves().items())
    for (const long double t : {0.0L, 0.31L, 0.77L}) {
      const Vec p = curve.at(t);
      if (b.winding(p) == 1 || b.curves().nearest(p).distance <= slack) continue;
      RC_LOG() << "(" << p.x << ", " << p.y << ") is outside\n";
      RC_FAIL("the zone does not contain what it must");
    }
}

using Order = PropertyTest;

TEST_P(Order, ReversedShuffledAndRepeatedInput) {
  holds("the same zone", [](const ZoneCase& c) {
    ZoneCase d = c;
    for (InputPart& part : d.parts) std::reverse(part.vertices.begin(), part.vertices.end());
    // Rings of a feature may come in any order; so may all else.
    std::shuffle(d.parts.begin(), d.parts.end(), std::mt19937_64(seed()));
    d.parts.push_back(line(d.parts.front().vertices));
    if (d.parts.front().ring && d.parts.back().vertices.size() > 1)
      d.parts.back().vertices.push_back(d.parts.back().vertices.front());
    assert_same(c, d);
  });
}

TEST_P(Order, LinesAsSingleSegments) {
  holds("the same zone", [](const ZoneCase& c) {
    ZoneCase d{{}, c.radius};
    for (const InputPart& part : c.parts) {
      if (part.ring || part.vertices.size() == 1)
        d.parts.push_back(part);
      else
        for (std::size_t i = part.vertices.size() - 1; i > 0; --i)
          d.parts.push_back(line({part.vertices[i], part.vertices[i - 1]}));
    }
    assert_same(c, d);
  });
}

TEST_P(Order, HoldsTheInput) {
  holds("the input is inside", [](const ZoneCase& c) {
    const auto zone = zone_of(c);
    RC_ASSERT(zone.ok());
    const Obstacle obstacle(c.parts);
    const Boundary boundary(plain(*zone), obstacle, {c.radius, tolerance(*zone, obstacle)});
    if (c.radius < 4 * tolerance(*zone, obstacle)) return;
    for (const auto& s : obstacle.segments().items())
      for (const long double t : {0.0L, 0.5L, 1.0L})
        RC_ASSERT(boundary.winding(Vec(s.a) + t * (Vec(s.b) - Vec(s.a))) == 1);
  });
}

TEST_P(Order, GrowsWithTheInput) {
  holds("monotone in the input", [](const ZoneCase& c) {
    if (c.parts.size() < 2) return;
    ZoneCase less = c;
    // A ring fewer may be a hole fewer, so polygons go as a whole.
    const auto last = less.parts.back();
    std::erase_if(less.parts, [&](const InputPart& p) { return last.ring && p.ring && p.feature == last.feature; });
    if (!last.ring) less.parts.pop_back();
    if (less.parts.empty()) return;
    const auto a = zone_of(less), b = zone_of(c);
    RC_ASSERT(a.ok());
    RC_ASSERT(b.ok());
    const Obstacle p(less.parts), q(c.parts);
    const double slack = tolerance(*b, q);
    RC_ASSERT(a->area() <= b->area() + slack * b->perimeter());
    assert_inside(*a, p, *b, q, slack);
  });
}

TEST_P(Order, GrowsWithTheRadius) {
  holds("monotone in R", [](const ZoneCase& c) {
    ZoneCase more = c;
    more.radius *= *rc::gen::element(1 + 1e-12, 1.0001, 1.5, 10.0);
    const auto a = zone_of(c), b = zone_of(more);
    RC_ASSERT(a.ok());
    RC_ASSERT(b.ok());
    const Obstacle obstacle(c.parts);
    const double slack = tolerance(*b, obstacle);
    RC_ASSERT(a->area() <= b->area() + slack * b->perimeter());
    assert_inside(*a, obstacle, *b, obstacle, slack);
  });
}

KREPL_FOR_ALL_FAMILIES(Order);

}  // namespace
}  // namespace krepl::test
