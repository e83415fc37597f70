// Moving, turning, mirroring and scaling the input does the same to its zone.
#include <cmath>

#include "support/zone_property.hpp"

namespace krepl::test {
namespace {

struct Motion {
  const char* name;
  Point (*move)(Point);
  double scale;
};

/// Exact on doubles, so that even ties must be decided the same way.
const Motion exact[] = {
    {"turn by 90 degrees",
     [](Point p) {
       return Point{-p.y, p.x};
     },
     1},
    {"turn by 180 degrees",
     [](Point p) {
       return Point{-p.x, -p.y};
     },
     1},
    {"mirror",
     [](Point p) {
       return Point{-p.x, p.y};
     },
     1},
    {"mirror at the diagonal",
     [](Point p) {
       return Point{p.y, p.x};
     },
     1},
    {"double",
     [](Point p) {
       return Point{2 * p.x, 2 * p.y};
     },
     2},
    {"shrink",
     [](Point p) {
       return Point{std::ldexp(p.x, -40), std::ldexp(p.y, -40)};
     },
     0x1p-40},
};

/// Exact on small integers.
const Motion shifts[] = {
    {"shift",
     [](Point p) {
       return Point{p.x + 1000, p.y - 37};
     },
     1},
    {"shift far",
     [](Point p) {
       return Point{p.x - 500000, p.y + 4700000};
     },
     1},
};

const Motion rounded[] = {
    {"turn",
     [](Point p) {
       return Point{std::cos(0.7) * p.x - std::sin(0.7) * p.y, std::sin(0.7) * p.x + std::cos(0.7) * p.y};
     },
     1},
    {"turn by 3-4-5 and mirror",
     [](Point p) {
       return Point{0.6 * p.x + 0.8 * p.y, 0.8 * p.x - 0.6 * p.y};
     },
     1},
    {"scale",
     [](Point p) {
       return Point{p.x / 3, p.y / 3};
     },
     1 / 3.0},
};

ZoneCase moved(const ZoneCase& c, const Motion& motion) {
  ZoneCase other = c;
  for (InputPart& part : other.parts)
    for (Point& p : part.vertices) p = motion.move(p);
  other.radius *= motion.scale;
  return other;
}

double largest_coordinate(const ZoneCase& c) {
  double largest = c.radius;
  for (const InputPart& part : c.parts)
    for (const Point& p : part.vertices) largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
  return largest;
}

/// Areas agree as far as rounding of the coordinates lets them.
void assert_same_area(const Zone& a, const Zone& b, double scale, double resolution) {
  const double expected = a.area() * scale * scale;
  const double slack = 1e-12 * expected + 64 * resolution * b.perimeter();
  RC_LOG() << "areas " << expected << ", " << b.area() << ", slack " << slack << '\n';
  RC_ASSERT(std::abs(b.area() - expected) <= slack);
}

bool on_integers(const ZoneCase& c) {
  for (const InputPart& part : c.parts)
    for (const Point& p : part.vertices)
      if (p.x != std::rint(p.x) || p.y != std::rint(p.y) || std::abs(p.x) > 1e6 || std::abs(p.y) > 1e6) return false;
  return true;
}

void assert_equivariant(const ZoneCase& c, const Motion& motion, bool same_rings) {
  const ZoneCase d = moved(c, motion);
  RC_LOG() << motion.name << ": " << text(d) << '\n';
  const auto a = zone_of(c), b = zone_of(d);
  RC_ASSERT(a.ok());
  RC_ASSERT(b.ok());
  if (same_rings) RC_ASSERT(counts(*a) == counts(*b));
  assert_same_area(*a, *b, motion.scale,
                   2.3e-16 * std::max(largest_coordinate(d), motion.scale * largest_coordinate(c)));
}

using Motions = PropertyTest;

TEST_P(Motions, Exact) {
  holds("equivariant", [](const ZoneCase& c) {
    assert_equivariant(c, *rc::gen::elementOf(std::vector(std::begin(exact), std::end(exact))), true);
  });
}

TEST_P(Motions, Shifts) {
  holds("equivariant under shifts", [](const ZoneCase& c) {
    if (!on_integers(c)) return;
    for (const Motion& shift : shifts) {
      const double step = 2.3e-16 * largest_coordinate(moved(c, shift));
      if (c.radius < 1e6 * step) continue;  // too fine for the shifted coordinates
      // The zone is that of a radius up to 16 steps larger, so a ring that closes just there may close.
      ZoneCase more = c;
      more.radius += 64 * step;
      const auto now = zone_of(c), then = zone_of(more);
      RC_ASSERT(now.ok());
      RC_ASSERT(then.ok());
      assert_equivariant(c, shift, counts(*now) == counts(*then));
    }
  });
}

// Where the rings do not change in a neighbourhood of R, rounding of the motion must not change them.
TEST_P(Motions, Rounded) {
  holds("equivariant up to rounding", [](const ZoneCase& c) {
    ZoneCase less = c, more = c;
    less.radius *= 1 - 1e-7, more.radius *= 1 + 1e-7;
    const auto l = zone_of(less), m = zone_of(more);
    RC_ASSERT(l.ok());
    RC_ASSERT(m.ok());
    const bool stable = counts(*l) == counts(*m) && largest_coordinate(c) < 1e6 * c.radius;
    assert_equivariant(c, *rc::gen::elementOf(std::vector(std::begin(rounded), std::end(rounded))), stable);
  });
}

KREPL_FOR_ALL_FAMILIES(Motions);

}  // namespace
}  // namespace krepl::test
