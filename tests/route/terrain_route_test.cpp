// Routes over terrain: every one is measured by brute force in extended precision (BallOracle) at many places; lengths
// against closed forms, and against a coarse search of voxels whose heights come from the oracle. Blind spots: that no
// shorter route exists is seen only as far as voxels tell, some per cent.
#include <gtest/gtest.h>

#include <cmath>
#include <queue>
#include <random>

#include "krepl/terrain_route.hpp"
#include "support/ball_oracle.hpp"
#include "support/environment.hpp"

namespace krepl::test {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

struct Flight {
  SmallTerrain terrain;
  TerrainRouteOptions options;
};

Result<TerrainRoute> fly(const Flight& f) {
  auto terrain = terrain_of(f.terrain);
  EXPECT_TRUE(terrain.ok());
  auto cutter = DropCutter::build(*terrain, f.terrain.radius);
  EXPECT_TRUE(cutter.ok());
  return compute_terrain_route(*cutter, f.options);
}

/// What is wrong with a route, by brute force; nothing if all is well.
std::optional<std::string> fault_in(const TerrainRoute& route, const Flight& f) {
  const auto triangles = triangles_of(f.terrain);
  const BallOracle oracle(triangles, {0, 0, 0}, f.terrain.radius);
  double scale = f.terrain.radius;
  for (const auto& t : triangles)
    for (Point3 p : t) scale = std::max({scale, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  const double tolerance = 1.001e-9 * scale;
  const auto complaint = [&](const char* what, std::size_t i, double found, double wanted) {
    return std::string(what) + " at " + std::to_string(i) + ": " + std::to_string(found) + " against " +
           std::to_string(wanted);
  };
  const auto& p = route.points;
  if (p.size() < 2) return "fewer than two points";
  double length = 0, climb = 0;
  Long nearest = 1e300L;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p[i].z > f.options.ceiling + tolerance) return complaint("above the ceiling", i, p[i].z, f.options.ceiling);
    if (i + 1 == p.size()) break;
    const double way = std::hypot(p[i + 1].x - p[i].x, p[i + 1].y - p[i].y), rise = p[i + 1].z - p[i].z;
    const bool lift = way == 0 && ((i == 0 && !f.options.from.height) || (i + 2 == p.size() && !f.options.to.height));
    if (!lift && std::abs(rise) > f.options.max_slope * way * (1 + 1e-9) + tolerance)
      return complaint("too steep", i, rise / way, f.options.max_slope);
    length += std::hypot(way, rise), climb += std::max(rise, 0.0);
    for (int k = 0; k <= 40; ++k) {
      const Long t = k / 40.0L;
      const LongPoint at{p[i].x + t * (p[i + 1].x - p[i].x), p[i].y + t * (p[i + 1].y - p[i].y),
                         p[i].z + t * (p[i + 1].z - p[i].z)};
      const Long rests = oracle.height({double(at.x), double(at.y)});
      // Where the surface is steep, heights tell less than distances; below it is what must not be.
      if (at.z < rests - f.terrain.radius / 2) return complaint("below the surface", i, double(at.z), double(rests));
      nearest = std::min(nearest, oracle.distance(at));
    }
  }
  if (nearest < route.clearance - tolerance) return complaint("clearance", 0, double(nearest), route.clearance);
  if (route.clearance < f.terrain.radius - tolerance)
    return complaint("clearance below the radius", 0, route.clearance, f.terrain.radius);
  if (std::abs(length - route.length) > tolerance * double(p.size()))
    return complaint("length", 0, route.length, length);
  if (std::abs(climb - route.climb) > tolerance * double(p.size())) return complaint("climb", 0, route.climb, climb);
  return std::nullopt;
}

void expect_sound(const Result<TerrainRoute>& route, const Flight& f) {
  ASSERT_TRUE(route.ok()) << route.error().text() << "\n" << f.terrain;
  EXPECT_EQ(fault_in(*route, f).value_or("none"), "none") << f.terrain;
}

Flight over_grid(std::size_t columns, std::size_t rows, double radius) {
  Flight f;
  f.terrain.grid.columns = columns, f.terrain.grid.rows = rows;
  f.terrain.heights.assign(columns * rows, 0.0);
  f.terrain.radius = radius;
  return f;
}

TEST(TerrainRoute, StraightOverTheLevel) {
  Flight f = over_grid(21, 11, 1);
  f.options.from = {{1, 1}, {}}, f.options.to = {{18.5, 9.25}, {}};
  const auto route = fly(f);
  expect_sound(route, f);
  EXPECT_NEAR(route->length, std::hypot(17.5, 8.25), 0.005);
  EXPECT_EQ(route->clearance, 1);
  f.options.from.height = 5, f.options.to.height = 3;
  const auto high = fly(f);
  expect_sound(high, f);
  EXPECT_NEAR(high->length, std::hypot(17.5, 8.25, 2), 1e-6);
  EXPECT_NEAR(high->clearance, 3, 1e-3);
  EXPECT_LE(high->clearance, 3);
  f.options.to = f.options.from;
  EXPECT_NEAR(fly(f)->length, 0, 1e-12);
}

/// A roof whose ridge runs along y, 10 high over x = 0.
Flight over_roof() {
  Flight f;
  f.terrain.is_grid = false, f.terrain.radius = 2;
  const Point3 a{-10, -20, 0}, b{-10, 20, 0}, c{0, -20, 10}, d{0, 20, 10}, e{10, -20, 0}, g{10, 20, 0};
  f.terrain.triangles = {{a, c, b}, {b, c, d}, {c, e, d}, {d, e, g}};
  return f;
}

TEST(TerrainRoute, OverARidgeAsATautString) {
  Flight f = over_roof();
  f.options.from = {{-8, 0}, 6}, f.options.to = {{8, 0}, 6};
  f.options.step = 0.5;
  const auto route = fly(f);
  expect_sound(route, f);
  // Two tangents to the circle of radius 2 about the ridge, and the arc between them.
  const double away = std::hypot(8, 4), straight = std::sqrt(away * away - 4);
  const double turned = 2 * (std::atan2(8.0, -4.0) - std::acos(2 / away));
  EXPECT_GE(route->length, 2 * straight + 2 * turned - 1e-9);
  EXPECT_LE(route->length, (2 * straight + 2 * turned) * 1.001);
  EXPECT_LE(route->length, route->lattice_length);
  // Straight up and down is the way from the surface with the least climb.
  f.options.from.height.reset(), f.options.to.height.reset();
  f.options.minimise = TerrainRouteOptions::Minimise::climb;
  const auto climb = fly(f);
  expect_sound(climb, f);
  EXPECT_NEAR(climb->climb, 12 - (2 + 2 * std::sqrt(2.0)), 0.02);
}

TEST(TerrainRoute, SlopeIsKept) {
  Flight f = over_roof();
  f.options.from = {{-8, 0}, {}}, f.options.to = {{8, 0}, {}};
  for (const double slope : {0.1, 0.5, 2.0}) {
    f.options.max_slope = slope;
    const auto route = fly(f);
    expect_sound(route, f);
    EXPECT_LE(route->steepest, slope * (1 + 1e-9));
  }
  // From given heights below the ridge it has to wind its way up.
  f.options.from.height = 6, f.options.to.height = 6, f.options.max_slope = 0.5, f.options.step = 1;
  const auto winding = fly(f);
  expect_sound(winding, f);
  EXPECT_GE(winding->length, 2 * 6 * std::sqrt(5.0) - 0.1);
}

TEST(TerrainRoute, UnderACeilingThroughAGap) {
  Flight f = over_grid(31, 31, 1);
  for (std::size_t row = 0; row < 31; ++row)
    if (row < 22 || row > 26) f.terrain.heights[row * 31 + 15] = 20;
  f.options.from = {{5, 5}, {}}, f.options.to = {{25, 5}, {}};
  f.options.step = 1;
  f.options.ceiling = 10;
  const auto around = fly(f);
  expect_sound(around, f);
  double north = 0;
  for (Point3 p : around->points) north = std::max(north, p.y);
  EXPECT_GT(north, 20);
  EXPECT_LT(around->length, 2 * std::hypot(10, 18) + 4);
  for (std::size_t row = 22; row <= 26; ++row) f.terrain.heights[row * 31 + 15] = 20;
  f.options.ceiling = 10;
  const auto closed = fly(f);
  ASSERT_FALSE(closed.ok());
  EXPECT_NE(closed.error().text().find("no route"), std::string::npos);
  f.options.ceiling = unlimited;
  const auto over = fly(f);
  expect_sound(over, f);
  EXPECT_GT(over->climb, 19.9);
}

TEST(TerrainRoute, Errors) {
  Flight f = over_grid(11, 11, 1);
  f.options.from = {{1, 1}, {}}, f.options.to = {{9, 9}, {}};
  const auto expect_error = [&](const Flight& wrong, const std::string& text) {
    const auto route = fly(wrong);
    ASSERT_FALSE(route.ok()) << text;
    EXPECT_NE(route.error().text().find(text), std::string::npos) << route.error().text();
  };
  Flight g = f;
  g.options.from.height = 0.25;
  expect_error(g, "0.75 below where it rests, 1");
  g = f, g.options.to.place = {50, 50};
  expect_error(g, "--to is not over the terrain");
  g = f, g.options.ceiling = 0.5;
  expect_error(g, "above the ceiling");
  g = f, g.options.max_slope = 0;
  expect_error(g, "slope");
  g = f, g.options.step = -1;
  expect_error(g, "step");
  g = f, g.options.step = 1e-6;
  expect_error(g, "thirty million");
}

/// Length of the shortest way from voxel to voxel, 26 neighbours each, over the oracle's heights at their places.
double voxel_length(const Flight& f, double cell) {
  const BallOracle oracle(triangles_of(f.terrain), {0, 0, 0}, f.terrain.radius);
  const auto n = std::size_t(double(f.terrain.grid.columns - 1) / cell) + 1,
             m = std::size_t(double(f.terrain.grid.rows - 1) / cell) + 1;
  std::vector<double> floor(n * m);
  double low = 1e300, high = -low;
  for (std::size_t i = 0; i < n * m; ++i) {
    floor[i] = double(oracle.height({double(i % n) * cell, double(i / n) * cell}));
    if (std::isfinite(floor[i])) low = std::min(low, floor[i]), high = std::max(high, floor[i]);
  }
  const auto levels = std::size_t((high - low) / cell) + 3;
  const auto node_of = [&](const TerrainRouteEnd& e) {
    const auto x = std::size_t(std::lround(e.place.x / cell)), y = std::size_t(std::lround(e.place.y / cell));
    return (y * n + x) * levels + std::size_t(std::ceil((floor[y * n + x] - low) / cell - 1e-9));
  };
  std::vector<double> cost(n * m * levels, unlimited);
  using Waiting = std::pair<double, std::size_t>;
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> queue;
  const std::size_t from = node_of(f.options.from), to = node_of(f.options.to);
  cost[from] = 0, queue.push({0, from});
  while (!queue.empty()) {
    const auto [c, i] = queue.top();
    queue.pop();
    if (i == to) return c * cell;
    if (c > cost[i]) continue;
    const auto z = std::ptrdiff_t(i % levels), x = std::ptrdiff_t(i / levels % n), y = std::ptrdiff_t(i / levels / n);
    for (int k = 0; k < 27; ++k) {
      const std::ptrdiff_t u = x + k % 3 - 1, v = y + k / 3 % 3 - 1, w = z + k / 9 - 1;
      if (u < 0 || v < 0 || w < 0 || u >= std::ptrdiff_t(n) || v >= std::ptrdiff_t(m) || w >= std::ptrdiff_t(levels))
        continue;
      const std::size_t column = std::size_t(v) * n + std::size_t(u);
      if (!(low + double(w) * cell >= floor[column] - 1e-9)) continue;
      const std::size_t j = column * levels + std::size_t(w);
      const double next = c + std::sqrt(double((u - x) * (u - x) + (v - y) * (v - y) + (w - z) * (w - z)));
      if (next < cost[j]) cost[j] = next, queue.push({next, j});
    }
  }
  return unlimited;
}

TEST(TerrainRoute, RandomTerrainsAgainstVoxels) {
  std::mt19937_64 random(seed());
  int bent = 0;
  for (int i = 0; i < int(20 * effort()); ++i) {
    Flight f = over_grid(9, 9, 0.3 + 0.2 * double(random() % 6));
    f.terrain.grid.split = Terrain::Split(random() % 3);
    for (double& h : f.terrain.heights) h = double(random() % 4 == 0 ? random() % 6 : random() % 2);
    f.options.from = {{1, 1}, {}}, f.options.to = {{7, double(1 + random() % 7)}, {}};
    f.options.step = 0.25;
    const bool limited = random() % 3 == 0;
    if (limited) f.options.max_slope = 0.25 * double(1 + random() % 4);
    SCOPED_TRACE(testing::Message() << "seed " << seed() << " round " << i);
    const auto route = fly(f);
    expect_sound(route, f);
    if (!route.ok()) continue;
    EXPECT_LE(route->length, route->lattice_length * (1 + 1e-12));
    bent += route->points.size() > 2;
    if (limited) continue;
    const double voxels = voxel_length(f, 0.25);
    EXPECT_LE(route->length, voxels * 1.05 + 0.5);
    EXPECT_GE(route->length, voxels / 1.13 - 1);
  }
  EXPECT_GT(bent, 5 * effort());
}

}  // namespace
}  // namespace krepl::test
