// The thesis's extremal constructions: 2n + 2 vertices (theorem 2.3.4), n - 1 explicit ones, and never more.
#include <gtest/gtest.h>

#include <cmath>

#include "support/environment.hpp"
#include "terrain_case.hpp"

namespace krepl::test {

namespace {

/// n segments on a half circle or part of it, from the left horizon to the right one.
Terrain chain(std::size_t n, double from, double to, double size, bool convex) {
  Terrain t;
  for (std::size_t i = 0; i <= n; ++i) {
    const double a = from + (to - from) * double(i) / double(n);
    t.push_back({-size * std::cos(a), (convex ? 1 : -1) * size * std::sin(a)});
  }
  return t;
}

TEST(Complexity, StrictlyConvexChainHasAllVertices) {
  for (const std::size_t n : {1u, 2u, 3u, 10u, 100u, 1000u})
    for (const double radius : {1e-3, 1.0, 1e3}) {
      const Terrain terrain = chain(n, 0.3, 2.8, 10, true);
      const Profile profile = profile_of(terrain, radius);
      EXPECT_EQ(profile.pieces.size() - 1, 2 * n + 2) << n << " segments, radius " << radius;
      EXPECT_EQ(count_profile_vertices(terrain, profile.pieces).explicit_ones, 0u);
      EXPECT_FALSE(fault_in(terrain, radius));
    }
}

TEST(Complexity, ValleyChainHasAllExplicitVertices) {
  // Radius below that of curvature: no segment of the bowl is hidden as a whole.
  for (const std::size_t n : {2u, 3u, 10u, 100u, 1000u}) {
    const Terrain terrain = chain(n, 0.3, 2.8, 10, false);
    const Profile profile = profile_of(terrain, 5);
    EXPECT_EQ(count_profile_vertices(terrain, profile.pieces).explicit_ones, n - 1);
    EXPECT_EQ(profile.pieces.size(), n + 4);
    EXPECT_FALSE(fault_in(terrain, 5));
  }
}

TEST(Complexity, SawTeethHaveExplicitVerticesAndArcs) {
  Terrain terrain;
  const std::size_t n = 1001;
  for (std::size_t i = 0; i <= n; ++i) terrain.push_back({double(i), i % 2 == 0 ? 0.0 : 1.0});
  const Profile profile = profile_of(terrain, 10);
  // Every peak shows its arc only; an explicit vertex between any two.
  EXPECT_EQ(count_profile_vertices(terrain, profile.pieces).explicit_ones, n / 2);
  EXPECT_FALSE(fault_in(terrain, 10));
}

TEST(Complexity, NeverAboveTheBounds) {
  std::mt19937_64 random(seed() + 7);
  for (int i = 0; i < int(2000 * effort()); ++i) {
    const Terrain terrain = families()[random() % families().size()].make(random, 1 + random() % 60);
    const Profile profile = profile_of(terrain, any_radius(random, terrain));
    std::size_t n = 0;
    for (std::size_t k = 1; k < terrain.size(); ++k) n += terrain[k] == terrain[k - 1] ? 0 : 1;
    const ProfileVertexCounts counts = count_profile_vertices(terrain, profile.pieces);
    ASSERT_LE(counts.all, 2 * n + 2) << text(terrain, profile.radius);
    ASSERT_LE(counts.explicit_ones, n > 0 ? n - 1 : 0) << text(terrain, profile.radius);
  }
}

}  // namespace

}  // namespace krepl::test
