// Snap rounding against all pairs, by exact arithmetic on small and on the largest coordinates.
#include "model/noding.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "kernel/orientation.hpp"
#include "support/environment.hpp"

namespace krepl::test {
namespace {

using model::GridPoint;
using model::GridSegment;
using model::Noding;

Point point(GridPoint p) { return {double(p.x), double(p.y)}; }

int orientation(GridPoint a, GridPoint b, GridPoint c) { return kernel::orientation(point(a), point(b), point(c)); }

bool in_box(GridPoint a, GridPoint b, GridPoint c) {
  return c.x >= std::min(a.x, b.x) && c.x <= std::max(a.x, b.x) && c.y >= std::min(a.y, b.y) &&
         c.y <= std::max(a.y, b.y);
}

/// True if two different segments share a point that is not a vertex of both.
bool meet_wrongly(GridPoint a, GridPoint b, GridPoint c, GridPoint d) {
  if (orientation(a, b, c) * orientation(a, b, d) < 0 && orientation(c, d, a) * orientation(c, d, b) < 0) return true;
  const auto inside = [](GridPoint p, GridPoint q, GridPoint v) {
    return v != p && v != q && in_box(p, q, v) && orientation(p, q, v) == 0;
  };
  return inside(a, b, c) || inside(a, b, d) || inside(c, d, a) || inside(c, d, b);
}

struct Case {
  std::vector<GridPoint> vertices;
  std::vector<GridSegment> segments;
};

Case random_case(std::mt19937_64& random, std::int64_t low, std::int64_t high, std::size_t count) {
  std::map<GridPoint, std::uint32_t> number;
  Case c;
  std::uniform_int_distribution<std::int64_t> coordinate(low, high);
  const auto vertex = [&] {
    const GridPoint p{coordinate(random), coordinate(random)};
    const auto [entry, fresh] = number.emplace(p, std::uint32_t(c.vertices.size()));
    if (fresh) c.vertices.push_back(p);
    return entry->second;
  };
  while (c.segments.size() < count) {
    const GridSegment s{vertex(), vertex()};
    if (s.a != s.b) c.segments.push_back(s);
  }
  return c;
}

/// Squared distance of v from the line a b times its squared length, against half a pixel's diagonal.
bool within_a_pixel(GridPoint a, GridPoint b, GridPoint v) {
  const long double dx = b.x - a.x, dy = b.y - a.y;
  const long double cross = dx * static_cast<long double>(v.y - a.y) - dy * static_cast<long double>(v.x - a.x);
  return std::abs(cross) <= std::sqrt(0.5L) * std::hypot(dx, dy) * (1 + 1e-12L);
}

void check(const Case& c) {
  const auto noding = model::node_segments(c.vertices, c.segments, {});
  ASSERT_TRUE(noding.has_value());
  ASSERT_GE(noding->vertices.size(), c.vertices.size());
  EXPECT_TRUE(std::equal(c.vertices.begin(), c.vertices.end(), noding->vertices.begin()));
  EXPECT_EQ(std::set(noding->vertices.begin(), noding->vertices.end()).size(), noding->vertices.size());
  const auto& v = noding->vertices;

  std::size_t at = 0;  // each segment is a chain from its start to its end, near itself
  for (std::uint32_t s = 0; s < c.segments.size(); ++s) {
    std::uint32_t vertex = c.segments[s].a;
    for (; at < noding->fragments.size() && noding->fragments[at].segment == s; ++at) {
      EXPECT_EQ(noding->fragments[at].from, vertex);
      vertex = noding->fragments[at].to;
      EXPECT_TRUE(within_a_pixel(v[c.segments[s].a], v[c.segments[s].b], v[vertex]));
    }
    EXPECT_EQ(vertex, c.segments[s].b);
  }
  EXPECT_EQ(at, noding->fragments.size());

  std::set<std::pair<std::uint32_t, std::uint32_t>> distinct;
  for (const Noding::Fragment& f : noding->fragments) distinct.insert(std::minmax(f.from, f.to));
  for (const auto& f : distinct) {
    for (const auto& g : distinct) {
      if (!(f < g)) continue;
      EXPECT_FALSE(meet_wrongly(v[f.first], v[f.second], v[g.first], v[g.second]));
    }
  }
}

TEST(Noding, PlanarByAllPairs) {
  std::mt19937_64 random(seed());
  for (int k = 0; k < int(300 * effort()); ++k) check(random_case(random, 0, 2 + k % 40, 2 + random() % 25));
  EXPECT_FALSE(testing::Test::HasFailure());
}

TEST(Noding, PlanarAtTheLargestCoordinates) {
  std::mt19937_64 random(seed() + 1);
  constexpr std::int64_t most = std::int64_t{1} << 53;
  for (int k = 0; k < int(60 * effort()); ++k) {
    check(random_case(random, -most, most, 2 + random() % 12));
    check(random_case(random, most - 30, most, 2 + random() % 25));
  }
}

TEST(Noding, FansOfNearlyParallelSegments) {
  std::mt19937_64 random(seed() + 2);
  for (int k = 0; k < int(50 * effort()); ++k) {
    // Long and nearly in one line: crossings are ill-conditioned and share pixels.
    std::map<GridPoint, std::uint32_t> number;
    Case c;
    const auto vertex = [&](std::int64_t x) {
      const GridPoint p{x + std::int64_t(random() % 5), std::int64_t(random() % 4)};
      const auto [entry, fresh] = number.emplace(p, std::uint32_t(c.vertices.size()));
      if (fresh) c.vertices.push_back(p);
      return entry->second;
    };
    for (int s = 0; s < 15; ++s) c.segments.push_back({vertex(0), vertex(1000 + std::int64_t(random() % 3) * 500)});
    check(c);
  }
}

TEST(Noding, CrossingsAreRoundedExactly) {
  std::mt19937_64 random(seed() + 3);
  const auto floor_of = [](__int128 n, __int128 d) { return std::int64_t(n / d - (n % d < 0 ? 1 : 0)); };
  std::size_t halves = 0, tried = 0;
  for (int k = 0; k < int(20000 * effort()); ++k) {
    const Case c = random_case(random, -20, 20, 2);
    const GridPoint p = c.vertices[c.segments[0].a], q = c.vertices[c.segments[0].b], r = c.vertices[c.segments[1].a],
                    s = c.vertices[c.segments[1].b];
    if (orientation(p, q, r) * orientation(p, q, s) >= 0 || orientation(r, s, p) * orientation(r, s, q) >= 0) continue;
    ++tried;
    __int128 part = __int128(r.x - p.x) * (s.y - r.y) - __int128(r.y - p.y) * (s.x - r.x);
    __int128 whole = __int128(q.x - p.x) * (s.y - r.y) - __int128(q.y - p.y) * (s.x - r.x);
    if (whole < 0) part = -part, whole = -whole;
    // floor(x + 1/2), where x = p.x + (q.x - p.x) part / whole
    const __int128 x = 2 * (p.x * whole + (q.x - p.x) * part) + whole,
                   y = 2 * (p.y * whole + (q.y - p.y) * part) + whole;
    halves += x % (2 * whole) == 0 || y % (2 * whole) == 0;
    EXPECT_EQ(model::rounded_crossing(p, q, r, s), (GridPoint{floor_of(x, 2 * whole), floor_of(y, 2 * whole)}));
  }
  EXPECT_GT(halves, tried / 200);
}

TEST(Noding, PixelsTileThePlane) {
  // Along a segment, the pixels passed make a connected path: every point of it, sampled finely, is in a passed pixel.
  std::mt19937_64 random(seed() + 4);
  for (int k = 0; k < int(200 * effort()); ++k) {
    const Case c = random_case(random, -9, 9, 1);
    const GridPoint a = c.vertices[c.segments[0].a], b = c.vertices[c.segments[0].b];
    constexpr int steps = 720720;  // whole multiples of all small denominators
    for (int i = 0; i < 200; ++i) {
      const std::int64_t t = std::int64_t(random() % (steps + 1));
      // Exactly floor(a + (b - a) t / steps + 1/2)
      const auto pixel = [&](std::int64_t from, std::int64_t to) {
        const std::int64_t n = 2 * (from * steps + (to - from) * t) + steps, d = 2 * steps;
        return n >= 0 ? n / d : -((-n + d - 1) / d);
      };
      EXPECT_TRUE(model::passes_pixel(a, b, {pixel(a.x, b.x), pixel(a.y, b.y)}));
    }
  }
  EXPECT_TRUE(model::passes_pixel({0, 1}, {1, 0}, {1, 1}));   // through its lower left corner
  EXPECT_FALSE(model::passes_pixel({0, 1}, {1, 2}, {0, 2}));  // through its lower right one
  EXPECT_FALSE(model::passes_pixel({0, 0}, {1, 1}, {1, 0}));  // through its upper left one
}

}  // namespace
}  // namespace krepl::test
