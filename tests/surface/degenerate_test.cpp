// Terrains that are degenerate in ways known to have broken engines (one test each), by brute force.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "support/surface_faults.hpp"

namespace krepl::test {
namespace {

using Index = Surface::Index;
constexpr double missing = std::numeric_limits<double>::quiet_NaN();

SmallTerrain grid(std::size_t columns, std::size_t rows, const std::function<double(int, int)>& z) {
  SmallTerrain c;
  c.grid.columns = columns, c.grid.rows = rows;
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t k = 0; k < columns; ++k) c.heights.push_back(z(int(k), int(r)));
  }
  return c;
}

SmallTerrain mesh(const std::vector<Point3>& v, const std::vector<std::array<Index, 3>>& triangles) {
  SmallTerrain c;
  c.is_grid = false;
  for (const auto& t : triangles) c.triangles.push_back({v[t[0]], v[t[1]], v[t[2]]});
  return c;
}

void expect_sound(SmallTerrain c, std::initializer_list<double> radii) {
  for (const double radius : radii) {
    c.radius = radius;
    const auto fault = fault_in(c, {.points = 9, .lines = 40});
    EXPECT_FALSE(fault) << *fault << '\n' << text(c);
  }
}

Surface surface_of(SmallTerrain c, double radius) {
  c.radius = radius;
  auto surface = surface_within(c, 10);
  if (!surface) throw std::runtime_error(surface.error().text());
  return std::move(*surface);
}

/// A needle that pierces a face: the ball on its tip leaves the plane along a closed circle without any true vertex.
TEST(SurfaceDegenerate, NeedleUnderAPlaneMakesALoop) {
  const SmallTerrain c = mesh({{-40, -20, 0}, {40, -20, 0}, {0, 60, 0}, {1, 2, 0.5}, {1.125, 2, -20}, {1, 2.125, -20}},
                              {{0, 1, 2}, {3, 4, 5}});
  expect_sound(c, {2, 4, 8});
  const Surface s = surface_of(c, 4);
  const auto& d = s.subdivision();
  int loops = 0, valleys = 0;
  for (Index e = 0; e < d.edge_count(); ++e) {
    if (s.edge(e).kind != Surface::EdgeKind::valley) continue;
    ++valleys;
    if (d.origin[2 * e] != d.origin[2 * e + 1]) continue;
    ++loops;
    EXPECT_EQ(s.edge(e).curve, Surface::Curve::circle);
  }
  EXPECT_EQ(loops, 1);
  EXPECT_EQ(valleys, 1);
}

TEST(SurfaceDegenerate, NeedleInAGrid) {
  expect_sound(grid(5, 5, [](int c, int r) { return c == 2 && r == 2 ? 40.0 : 0.0; }), {0.3, 1, 2.5, 10});
}

/// All vertices inside have four contacts or more.
TEST(SurfaceDegenerate, EggCrate) {
  expect_sound(grid(6, 6, [](int c, int r) { return (c + r) % 2 == 0 ? 1.0 : 0.0; }), {0.3, 0.75, 1, 2.5, 10});
}

/// Pits between four, and between six, equal peaks.
TEST(SurfaceDegenerate, EqualPeaks) {
  expect_sound(grid(7, 7, [](int c, int r) { return c % 2 == 0 && r % 2 == 0 ? 2.0 : 0.0; }), {0.5, 1, 1.5, 2, 5});
  SmallTerrain c = grid(7, 7, [](int k, int r) { return k % 3 == 0 && r % 3 == 0 ? 2.0 : 0.0; });
  c.grid.split = Terrain::Split::shorter;
  expect_sound(c, {2.5, 5});
}

TEST(SurfaceDegenerate, PeakAtACorner) {
  SmallTerrain c = grid(3, 2, [](int k, int r) { return k == 0 && r == 1 ? 2.0 : 0.0; });
  for (const auto split : {Terrain::Split::rising, Terrain::Split::falling}) {
    c.grid.split = split;
    expect_sound(c, {1});
  }
}

TEST(SurfaceDegenerate, LakeShoreWithAThirdRidgeInItsPlane) {
  expect_sound(grid(8, 6, [](int c, int r) { return r == 5 ? 2.0 : std::max(0.0, double(c - 3)); }), {0.3, 1, 2.5});
  expect_sound(grid(7, 7, [](int c, int r) { return std::max(0.0, c + r - 6.0); }), {0.3, 1, 2.5, 10});
}

SmallTerrain channel(double bottom) {
  return mesh({{0, 0, 0},
               {0, 8, 0},
               {3, 0, -6},
               {3, 8, -6},
               {5, 0, bottom},
               {5, 8, bottom},
               {7, 0, -6},
               {7, 8, -6},
               {10, 0, 0},
               {10, 8, 0}},
              {{0, 2, 1}, {1, 2, 3}, {2, 4, 3}, {3, 4, 5}, {4, 6, 5}, {5, 6, 7}, {6, 8, 7}, {7, 8, 9}});
}

TEST(SurfaceDegenerate, ChannelWithAParallelLine) {
  expect_sound(channel(0), {3, 5, 6, 13});  // three lines at one height
  expect_sound(channel(-8), {13});          // the ball between the outer lines hangs down to -1 (5, 12, 13)
}

/// The ball touches three parallel lines at once, all along.
TEST(SurfaceDegenerateOpen, ChannelTouchingThreeParallelLines) { expect_sound(channel(-1), {13}); }

TEST(SurfaceDegenerate, FlatSlopesAndSharedPlanes) {
  expect_sound(grid(5, 4, [](int, int) { return 3.0; }), {0.3, 1, 2.5, 10});
  expect_sound(grid(5, 4, [](int c, int r) { return 2.0 * c - r; }), {0.3, 1, 2.5, 10});
}

/// Collinear edges meet at vertices whose patch has no width.
TEST(SurfaceDegenerate, RidgesAndChannels) {
  expect_sound(grid(7, 4, [](int c, int) { return -std::abs(c - 3.0); }), {0.3, 1, 2.5, 10});
  expect_sound(grid(7, 4, [](int c, int) { return std::abs(c - 3.0); }), {0.3, 1, 2.5, 10});
  expect_sound(grid(7, 4, [](int c, int r) { return -std::abs(c - 3.0) + r; }), {0.3, 1, 2.5});
  expect_sound(grid(7, 4, [](int c, int) { return c % 3 == 0 ? 1.0 : 0.0; }), {0.3, 1, 2.5, 10});
}

TEST(SurfaceDegenerate, Pyramids) {
  expect_sound(grid(7, 6, [](int c, int r) { return -double(std::max(std::abs(c - 3), std::abs(r - 2))); }),
               {0.3, 1, 2.5, 10});
  expect_sound(grid(7, 6, [](int c, int r) { return double(std::max(std::abs(c - 3), std::abs(r - 2))); }),
               {0.3, 1, 2.5, 10});
}

/// Between two faces, an edge and a face, a gap of exactly 180 degrees around a corner.
TEST(SurfaceDegenerate, FansAroundACorner) {
  const Point3 v{0, 0, 2}, a{4, 0, 2}, b{-4, 0, 2}, n{0, 4, 0}, s{0, -4, 0}, w{-2, 3, 0.5};
  expect_sound(mesh({v, a, b, n, s}, {{0, 1, 3}, {0, 3, 2}, {0, 2, 4}, {0, 4, 1}}), {0.5, 1, 3});
  expect_sound(mesh({v, a, b, n}, {{0, 1, 3}, {0, 3, 2}}), {0.5, 1, 3});
  expect_sound(mesh({v, a, b, n, s, w}, {{0, 1, 3}, {0, 3, 5}, {0, 5, 2}, {0, 2, 4}, {0, 4, 1}}), {0.5, 1, 3});
}

/// More edges at one vertex than any table of a fixed size holds, and ridges in one plane, all of whose pairs give one
/// corner.
TEST(SurfaceDegenerate, ManyEdgesAtOneVertex) {
  constexpr int facets = 150, ridges = 15;
  std::vector<Point3> v{{0, 0, 3}};
  std::vector<std::array<Index, 3>> triangles;
  for (int i = 0; i < facets; ++i) {
    const double angle = 2 * M_PI * i / facets;
    v.push_back({4 * std::cos(angle), 4 * std::sin(angle), 0});
    triangles.push_back({0, Index(1 + i), Index(1 + (i + 1) % facets)});
  }
  expect_sound(mesh(v, triangles), {0.5, 2});
  v = {{0, 0, 4}};
  triangles.clear();
  for (int i = 0; i < 2 * ridges; ++i) {
    v.push_back({1, i / 4.0, i % 2 == 0 ? 0.0 : -1.0});
    if (i > 0) triangles.push_back({0, Index(i), Index(i + 1)});
  }
  expect_sound(mesh(v, triangles), {0.5, 2, 10});
}

TEST(SurfaceDegenerate, Border) {
  expect_sound(mesh({{0, 0, 0}, {3, 0, 1}, {1, 2, 0.5}}, {{0, 1, 2}}), {0.2, 1, 3});
  expect_sound(mesh({{0, 0, 0}, {3, 0, 0}, {1, 2, 0}}, {{0, 1, 2}}), {0.2, 1, 3});
  expect_sound(grid(2, 2, [](int c, int r) { return double(c * r); }), {0.2, 1, 3});
}

TEST(SurfaceDegenerate, HolesAndIslands) {
  expect_sound(grid(7, 6, [](int c, int r) { return c == 3 && r == 3 ? missing : double((c * r) % 3); }),
               {0.3, 1, 2.5});
  expect_sound(grid(7, 6, [](int c, int r) { return c == 3 && r == 3 ? missing : 1.0; }), {0.3, 0.5, 1, 2.5});
  expect_sound(grid(7, 4, [](int c, int) { return c == 3 ? missing : 1.0; }), {0.3, 1, 2.5});
}

TEST(SurfaceDegenerate, BoxWithWalls) {
  expect_sound(
      mesh({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}}, {{4, 5, 6},
                                                                                                      {4, 6, 7},
                                                                                                      {0, 2, 1},
                                                                                                      {0, 3, 2},
                                                                                                      {0, 1, 5},
                                                                                                      {0, 5, 4},
                                                                                                      {1, 2, 6},
                                                                                                      {1, 6, 5},
                                                                                                      {2, 3, 7},
                                                                                                      {2, 7, 6},
                                                                                                      {3, 0, 4},
                                                                                                      {3, 4, 7}}),
      {0.2, 1, 3});
}

TEST(SurfaceDegenerate, OneAboveTheOther) {
  expect_sound(mesh({{0, 0, 0}, {4, 0, 0}, {2, 3, 0}, {1, 1, 2}, {3, 1.5, 2}, {2, -1, 2.5}}, {{0, 1, 2}, {3, 4, 5}}),
               {0.2, 0.5, 1, 3});
}

TEST(SurfaceDegenerate, CoordinatesOfUtmSize) {
  for (SmallTerrain c : {grid(6, 5, [](int k, int r) { return double((k * 7 + r * 5) % 4); }),
                         grid(6, 5, [](int k, int r) { return (k + r) % 2 == 0 ? 1.0 : 0.0; })}) {
    c.grid.first = {500000.25, 4500000.5};
    expect_sound(c, {0.5, 1.5, 4});
    expect_sound(as_mesh(c), {0.5, 1.5, 4});
  }
}

/// The counter-example to theorem 4.5.4: the boundary of the triangle that is last in every order meets the rest in a
/// loop and an arc. Both must be found.
TEST(SurfaceDegenerate, CounterExampleToOneConnectedArc) {
  std::vector<Point3> v{{0, 0, 0},          {1, 10, 0},    {-1, 10, 0},   {-0.70, 5, -0.3}, {-0.80, 4.8, -0.4},
                        {-0.80, 5.2, -0.4}, {-0.76, 5, 4}, {-12, 10, -8}, {-3, -12, -8}};
  const std::size_t left = v.size();
  for (std::size_t i = 3; i < left; ++i) v.push_back({-v[i].x, v[i].y, v[i].z});
  // A, B', B, Q, Q2, Q3, N, F, G: 0 to 8, and mirrored from Q on.
  std::vector<std::array<Index, 3>> t{{0, 1, 2}, {0, 8, 14}};
  for (const bool right : {false, true}) {
    const Index b = right ? 1 : 2, o = right ? 6 : 0, q = 3 + o, q2 = 4 + o, q3 = 5 + o, n = 6 + o, f = 7 + o,
                g = 8 + o;
    for (const std::array<Index, 3> triangle : {std::array<Index, 3>{0, b, q},
                                                {0, q, q2},
                                                {q, b, q3},
                                                {q, n, q2},
                                                {q, q3, n},
                                                {q2, n, q3},
                                                {b, f, q3},
                                                {q3, f, q2},
                                                {q2, f, g},
                                                {g, 0, q2}}) {
      t.push_back(triangle);
    }
  }
  expect_sound(mesh(v, t), {1});
  // The features of the last triangle own two separate regions: near the notch's tip and near its mouth.
  const Surface s = surface_of(mesh(v, t), 1);
  const auto corner_of_notch = [&](Point3 p) {
    const Point3 o = s.terrain().origin();
    return (p == Point3{0 - o.x, 0 - o.y, 0 - o.z}) || (p == Point3{1 - o.x, 10 - o.y, 0 - o.z}) ||
           (p == Point3{-1 - o.x, 10 - o.y, 0 - o.z});
  };
  const auto& d = s.subdivision();
  std::vector<Index> group(d.face_count());
  for (Index f = 0; f < group.size(); ++f) group[f] = f;
  const std::function<Index(Index)> root = [&](Index f) { return group[f] == f ? f : group[f] = root(group[f]); };
  const auto ours = [&](Index f) {
    if (f == 0 || s.face_feature(f) == Surface::none) return false;
    const auto c = s.terrain().corners(s.face_feature(f));
    for (int k = 0; k < c.count; ++k) {
      if (!corner_of_notch(c.point[std::size_t(k)])) return false;
    }
    return true;
  };
  for (Index e = 0; e < d.edge_count(); ++e) {
    const Index f = d.face[2 * e], g = d.face[2 * e + 1];
    if (ours(f) && ours(g)) group[root(f)] = root(g);
  }
  int regions = 0;
  for (Index f = 1; f < d.face_count(); ++f) regions += ours(f) && root(f) == f;
  EXPECT_EQ(regions, 2);
}

}  // namespace
}  // namespace krepl::test
