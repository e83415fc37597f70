// What a Terrain keeps and refuses: exact coordinates, order, reports, errors.
#include "krepl/terrain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>

#include "model/exact_origin.hpp"
#include "model/terrain_window.hpp"
#include "support/environment.hpp"

namespace krepl::test {
namespace {

using Index = Terrain::Index;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// True if a - b is a double.
bool exact_difference(double a, double b) {
  const double d = a - b;
  return d + b == a && __float128(a) - __float128(b) == __float128(d);
}

TEST(ExactOrigin, EveryNumberBetweenIsSubtractedExactly) {
  std::mt19937_64 engine(seed());
  const auto real = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); };
  for (int run = 0; run < int(20000 * effort()); ++run) {
    const double middle = std::ldexp(real(-1, 1), int(real(-40, 60))),
                 half = std::abs(middle) * std::ldexp(real(0, 1), int(real(-55, 3)));
    const double low = middle - half, high = middle + half, origin = exact_origin(low, high);
    for (int i = 0; i < 10; ++i) {
      const double v = i == 0 ? low : i == 1 ? high : std::clamp(real(low, high), low, high);
      ASSERT_TRUE(origin == 0 || exact_difference(v, origin)) << std::hexfloat << v << " - " << origin;
    }
    ASSERT_LE(std::max(std::abs(low - origin), std::abs(high - origin)), std::max(std::abs(low), std::abs(high)));
  }
}

std::string fault(const Result<Terrain>& terrain) { return terrain.ok() ? "no error" : terrain.error().text(); }

Terrain::Grid grid(std::size_t columns, std::size_t rows) {
  Terrain::Grid g;
  g.columns = columns, g.rows = rows;
  return g;
}

TEST(TerrainFromGrid, FarAwayNothingIsRounded) {
  Terrain::Grid g = grid(3, 2);
  g.first = {4500000.25, 5800000.125}, g.cell_x = 0.5, g.cell_y = 2;
  const auto terrain = Terrain::from_grid(g, {1000.1, 1000.2, 1000.3, 1000.4, 1000.5, 1000.7});
  ASSERT_TRUE(terrain.ok()) << terrain.error().text();
  const Point3 o = terrain->origin();
  EXPECT_LT(terrain->extent(), 4);
  for (Index s = 0; s < 6; ++s) {
    const Point3 p = terrain->corners(6 * s).point[0];
    EXPECT_EQ(p.x + o.x, 4500000.25 + 0.5 * (s % 3));
    EXPECT_EQ(p.y + o.y, 5800000.125 + 2 * (s / 3));
    EXPECT_EQ(p.z + o.z, (std::array{1000.1, 1000.2, 1000.3, 1000.4, 1000.5, 1000.7})[s]);
  }
  EXPECT_EQ(terrain->highest().x - terrain->lowest().x, 1);
  EXPECT_EQ(terrain->highest().z + o.z, 1000.7);
}

TEST(TerrainFromGrid, SamplesWithoutTriangleDoNotCount) {
  // The sample 99 has data but no triangle.
  const auto terrain = Terrain::from_grid(grid(4, 2), {1, 2, nan, 99, 3, 4, nan, nan});
  ASSERT_TRUE(terrain.ok()) << terrain.error().text();
  EXPECT_EQ(terrain->triangle_count(), 2u);
  EXPECT_EQ(terrain->report().missing_samples, 3u);
  EXPECT_EQ(terrain->highest().z + terrain->origin().z, 4);
  EXPECT_EQ(terrain->highest().x + terrain->origin().x, 1);
}

TEST(TerrainFromGrid, WhatIsRefused) {
  EXPECT_EQ(fault(Terrain::from_grid(grid(1, 5), std::vector<double>(5))), "a grid needs 2 x 2 samples or more, 1 x 5");
  EXPECT_EQ(fault(Terrain::from_grid(grid(0, 0), {})), "a grid needs 2 x 2 samples or more, 0 x 0");
  EXPECT_EQ(fault(Terrain::from_grid(grid(2, 2), {1, 2, 3})), "the number of heights is not columns times rows, 3");
  EXPECT_EQ(fault(Terrain::from_grid(grid(2, 2), {nan, nan, nan, nan})), "all samples of the grid are without data");
  EXPECT_EQ(fault(Terrain::from_grid(grid(2, 2), {1, 2, nan, nan})),
            "no triangle is left: no three neighbouring samples of a cell have data");
  EXPECT_EQ(fault(Terrain::from_grid(grid(3, 2), {1, 2, 3, 4, -infinity, infinity})),
            "a height is infinite, column 1, row 1; correct it or mark it as missing");
  EXPECT_EQ(fault(Terrain::from_grid(grid(2, 2), {1e308, -1e308, 0, 0})),
            "the heights are too large for double precision; scale them down");
  EXPECT_EQ(fault(Terrain::from_grid(grid(std::size_t{1} << 20, std::size_t{1} << 10), {})),
            "there are more than 2^29 samples in the grid; split the input");
  EXPECT_EQ(fault(Terrain::from_grid(grid(std::size_t{1} << 40, std::size_t{1} << 40), {})),
            "there are more than 2^29 samples in the grid; split the input");
  Terrain::Grid g = grid(2, 2);
  for (const double cell : {0.0, -1.0, nan}) {
    g.cell_y = cell;
    EXPECT_FALSE(Terrain::from_grid(g, {1, 2, 3, 4}).ok());
  }
  g = grid(2, 2), g.first.x = infinity;
  EXPECT_EQ(fault(Terrain::from_grid(g, {1, 2, 3, 4})),
            "the place of the grid is NaN or infinite; correct its first sample or cell size");
  g = grid(1000, 2), g.first = {-1e-3, 1e9}, g.cell_x = 1e-300;
  EXPECT_EQ(fault(Terrain::from_grid(g, std::vector<double>(2000))),
            "the cells of the grid are too small for coordinates of that size; shift or scale the grid");
}

TEST(TerrainFromTriangles, WhatIsRefused) {
  const std::vector<Point3> v{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}, {0, nan, 0}, {0, 0, infinity}};
  const auto refused = [&](std::vector<std::array<Index, 3>> triangles) {
    return fault(Terrain::from_triangles(v, std::move(triangles)));
  };
  EXPECT_EQ(refused({}), "there is no triangle");
  EXPECT_EQ(refused({{0, 1, 2}, {0, 1, 6}}),
            "vertex 6 does not exist, triangle 1; there are 6 vertices, counted from 0");
  EXPECT_EQ(refused({{0, 1, 4}}),
            "a coordinate is NaN or infinite, triangle 0, vertex 4; repair or remove the triangle");
  EXPECT_EQ(refused({{0, 1, 2}, {5, 1, 2}}),
            "a coordinate is NaN or infinite, triangle 1, vertex 5; repair or remove the triangle");
  EXPECT_EQ(refused({{0, 1, 3}, {1, 1, 2}}), "no triangle is left: all 2 have no area");
  EXPECT_EQ(refused({{0, 1, 2}}), "no error");
  EXPECT_EQ(fault(Terrain::from_triangles({{-1e308, 0, 0}, {1e308, 0, 0}, {0, 1, 0}}, {{0, 1, 2}})),
            "the coordinates are too large for double precision; scale the input down");
}

TEST(TerrainFromTriangles, SliversOfNoAreaInRoundedNumbers) {
  // 0.1, 0.2, 0.3 times one vector: collinear to the eye, not exactly.
  const std::vector<Point3> v{{0, 0, 0}, {0.1, 0.7, 0}, {0.3, 0.7 * 3, 0}, {1, 7, 0}};
  const auto nearly = Terrain::from_triangles(v, {{0, 1, 2}});
  ASSERT_TRUE(nearly.ok());
  EXPECT_EQ(nearly->report().zero_area_triangles, 0u);
  EXPECT_EQ(nearly->report().vertical_triangles, 0u);
}

TEST(TerrainFromTriangles, OrderOfTheInputDoesNotMatter) {
  std::mt19937_64 engine(seed());
  const auto integer = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine); };
  std::vector<std::array<Point3, 3>> soup;
  for (int i = 0; i < 3000; ++i) {
    const Point3 at{double(integer(0, 60)), double(integer(0, 60)), double(integer(0, 9))};
    std::array<Point3, 3> t{at, at, at};
    for (Point3& p : t) {
      p = {p.x + integer(-2, 2), p.y + integer(-2, 2), p.z};
      if (p.z == 0 && integer(0, 1) == 0) p.z = -0.0;
    }
    soup.push_back(t);
  }
  const auto build = [&](unsigned threads) {
    std::vector<Point3> vertices;
    std::vector<std::array<Index, 3>> triangles;
    for (const auto& t : soup) {
      const Index first = Index(vertices.size());
      vertices.insert(vertices.end(), t.begin(), t.end());
      triangles.push_back({first, first + 1, first + 2});
    }
    Context context;
    context.threads = threads;
    return Terrain::from_triangles(vertices, triangles, context);
  };
  const auto first = build(1);
  std::shuffle(soup.begin(), soup.end(), engine);
  for (auto& t : soup) std::shuffle(t.begin(), t.end(), engine);
  const auto second = build(3);
  ASSERT_TRUE(first.ok() && second.ok());
  ASSERT_EQ(first->feature_bound(), second->feature_bound());
  ASSERT_EQ(first->triangle_count(), second->triangle_count());
  for (Index f = 0; f < first->feature_bound(); ++f) {
    const auto a = first->corners(f), b = second->corners(f);
    ASSERT_EQ(a.count, b.count);
    for (int i = 0; i < a.count; ++i) {
      ASSERT_EQ(a.point[std::size_t(i)], b.point[std::size_t(i)]);
      ASSERT_EQ(std::signbit(a.point[std::size_t(i)].z), std::signbit(b.point[std::size_t(i)].z));
    }
  }
}

TEST(TerrainFromTriangles, CancelEndsIt) {
  std::atomic<bool> cancel{true};
  Context context;
  context.cancel = &cancel;
  const auto mesh = Terrain::from_triangles({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, context);
  ASSERT_FALSE(mesh.ok());
  EXPECT_EQ(mesh.error().code, ErrorCode::cancelled);
  const auto raster = Terrain::from_grid(grid(2, 2), {1, 2, 3, 4}, context);
  ASSERT_FALSE(raster.ok());
  EXPECT_EQ(raster.error().code, ErrorCode::cancelled);
}

/// A strip of many small triangles beside a few that span everything.
Terrain small_and_large(int n) {
  std::vector<Point3> vertices;
  std::vector<std::array<Index, 3>> triangles;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j < 2; ++j) vertices.push_back({double(i), double(j), double(i % 3)});
  for (Index i = 0; i < Index(n); ++i) {
    triangles.push_back({2 * i, 2 * i + 2, 2 * i + 3});
    triangles.push_back({2 * i, 2 * i + 3, 2 * i + 1});
  }
  for (int k = 0; k < 20; ++k) {  // slivers above the whole strip
    const Index first = Index(vertices.size());
    for (const Point3 p : {Point3{-1, -1.0 - k, 9}, Point3{n + 1.0, -1.0 - k, 9}, Point3{n / 2.0, n * 0.01, 9}})
      vertices.push_back(p);
    triangles.push_back({first, first + 1, first + 2});
  }
  auto terrain = Terrain::from_triangles(std::move(vertices), std::move(triangles));
  return std::move(*terrain);
}

TEST(TerrainWindowCost, FollowsWhatIsFound) {
  // A scan of all triangles would take minutes for these windows.
  const int n = 200000;
  const Terrain terrain = small_and_large(n);
  TerrainWindow window;
  const auto start = std::chrono::steady_clock::now();
  std::size_t found = 0;
  for (int i = 0; i < n; i += 4) {
    const double x = i - terrain.origin().x;
    window.fill(terrain, {x, 0.25 - terrain.origin().y}, {x + 2, 0.5 - terrain.origin().y});
    found += window.faces().size();
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_GT(found, std::size_t(n));
  EXPECT_LT(seconds, 30) << found << " triangles found";
}

}  // namespace
}  // namespace krepl::test
