// The exact sign of an area against 128-bit integers.
#include "kernel/orientation.hpp"

#include <gtest/gtest.h>

#include <random>

#include "support/environment.hpp"

namespace krepl::test {
namespace {

using Wide = __int128;

struct Lattice {
  long long x, y;
};

int exact_sign(Lattice a, Lattice b, Lattice c) {
  const Wide d = Wide(b.x - a.x) * (c.y - a.y) - Wide(b.y - a.y) * (c.x - a.x);
  return d > 0 ? 1 : d < 0 ? -1 : 0;
}

Point scaled(Lattice p, int exponent) {
  return {std::scalbn(double(p.x), exponent), std::scalbn(double(p.y), exponent)};
}

void expect_sign(Lattice a, Lattice b, Lattice c) {
  const int want = exact_sign(a, b, c);
  for (const int exponent : {0, -60, 300, -1000, 900}) {
    const Point p = scaled(a, exponent), q = scaled(b, exponent), r = scaled(c, exponent);
    ASSERT_EQ(kernel::orientation(p, q, r), want) << "2^" << exponent;
    ASSERT_EQ(kernel::exact_orientation(p, q, r), want) << "2^" << exponent;
    ASSERT_EQ(kernel::orientation(q, p, r), -want);
    ASSERT_EQ(kernel::orientation(q, r, p), want);
  }
}

TEST(Orientation, NearlyCollinear) {
  std::mt19937_64 engine(seed());
  const auto integer = [&](long long low, long long high) {
    return std::uniform_int_distribution<long long>(low, high)(engine);
  };
  const int cases = int(20000 * effort());
  int zeros = 0;
  for (int i = 0; i < cases; ++i) {
    const long long reach = 1LL << integer(1, 50);
    const Lattice a{integer(-reach, reach), integer(-reach, reach)},
        step{integer(-reach / 8, reach / 8), integer(-reach / 8, reach / 8)};
    const long long m = integer(-7, 7), n = integer(-7, 7);
    const Lattice b{a.x + m * step.x, a.y + m * step.y};
    const Lattice c{a.x + n * step.x + integer(-1, 1), a.y + n * step.y + integer(-1, 1)};
    zeros += exact_sign(a, b, c) == 0;
    ASSERT_NO_FATAL_FAILURE(expect_sign(a, b, c));
  }
  EXPECT_GT(zeros, cases / 20);
}

TEST(Orientation, CoordinatesOfVeryDifferentSize) {
  EXPECT_EQ(kernel::orientation({0, 0}, {1, 0x1p-600}, {1, 0}), -1);
  EXPECT_EQ(kernel::orientation({0, 0}, {0x1p300, 0x1p-300}, {0x1p300, 0x1p-300}), 0);
  EXPECT_EQ(kernel::orientation({0, 0}, {0x1p300, 0x1p-300}, {0x1p299, 0x1p-301}), 0);
  EXPECT_EQ(kernel::orientation({0, 0}, {0x1p300, 0x1p-300}, {0x1p299, 0x1.0000000000001p-301}), 1);
  EXPECT_EQ(kernel::orientation({-1, -1}, {0x1p60, 0x1p60}, {1, 1}), 0);
  EXPECT_EQ(kernel::orientation({0, 0}, {0, 0}, {0, 0}), 0);
}

TEST(Orientation, LinesInSpace) {
  EXPECT_TRUE(kernel::collinear({0.1, 0.2, 0.3}, {0.1, 0.2, 0.7}, {0.1, 0.2, -5}));
  EXPECT_TRUE(kernel::collinear({1, 2, 3}, {2, 4, 6}, {-3, -6, -9}));
  EXPECT_FALSE(kernel::collinear({1, 2, 3}, {2, 4, 6}, {-3, -6, -9.000000000000002}));
  EXPECT_FALSE(kernel::collinear({0, 0, 0}, {0, 0, 1}, {0, 1e-300, 0}));
}

}  // namespace
}  // namespace krepl::test
