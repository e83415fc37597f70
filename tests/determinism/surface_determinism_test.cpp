// The same terrain gives the same bits with any number of threads: hexadecimal dumps of all that a surface holds.
#include <cstdio>
#include <random>

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "krepl/surface.hpp"
#include "support/environment.hpp"
#include "support/small_terrain.hpp"

namespace krepl::test {
namespace {

std::string dump(Point3 p) {
  char buffer[100];
  std::snprintf(buffer, sizeof buffer, "%a %a %a\n", p.x, p.y, p.z);
  return buffer;
}

std::string dump(const Surface& surface) {
  std::string out;
  const Subdivision& s = surface.subdivision();
  for (Surface::Index v = 0; v < s.vertex_count; ++v) out += dump(surface.vertex(v));
  for (Surface::Index e = 0; e < s.edge_count(); ++e) {
    const Surface::Edge edge = surface.edge(e);
    out += std::to_string(int(edge.kind)) + " " + std::to_string(int(edge.curve)) + " " +
           std::to_string(edge.feature[0]) + " " + std::to_string(edge.feature[1]) + "\n";
    for (const Point3 p : surface.curve(e, 4)) out += dump(p);
  }
  for (std::size_t h = 0; h < s.half_edge_count(); ++h) {
    out += std::to_string(s.origin[h]) + " " + std::to_string(s.next[h]) + " " + std::to_string(s.face[h]) + "\n";
  }
  for (Surface::Index f = 0; f < s.face_count(); ++f) {
    out += std::to_string(surface.face_feature(f)) + " " + std::to_string(s.face_outer[f]);
    for (const auto h : s.inner_loops(f)) out += " " + std::to_string(h);
    out += "\n";
  }
  return out;
}

void expect_same_bits(const SmallTerrain& c, const std::string& what) {
  // Otherwise oneTBB starts no more threads than the machine has cores, whatever is asked for.
  const tbb::global_control eight(tbb::global_control::max_allowed_parallelism, 8);
  const auto terrain = terrain_of(c);
  ASSERT_TRUE(terrain) << terrain.error().text();
  std::string first;
  for (const unsigned threads : {1u, 2u, 3u, 8u, 1u}) {
    Context context;
    context.threads = threads;
    const auto surface = compute_surface(*terrain, {c.radius}, context);
    ASSERT_TRUE(surface) << what << ": " << surface.error().text();
    const std::string now = dump(*surface);
    if (first.empty())
      first = now;
    else
      ASSERT_TRUE(now == first) << what << " differs with " << threads << " threads";
  }
}

/// A grid large enough for many tiles.
SmallTerrain hills(std::size_t columns, std::size_t rows, unsigned most, double radius) {
  std::mt19937_64 random(seed());
  SmallTerrain c;
  c.grid.columns = columns, c.grid.rows = rows;
  c.radius = radius;
  for (std::size_t i = 0; i < columns * rows; ++i) c.heights.push_back(double(random() % most) / 64);
  return c;
}

TEST(SurfaceDeterminism, Hills) {
  for (const double radius : {0.7, 3.0}) expect_same_bits(hills(100, 90, 100, radius), "hills");
}

TEST(SurfaceDeterminism, EggCrate) {
  SmallTerrain c = hills(100, 90, 1, 1.1);
  for (std::size_t i = 0; i < c.heights.size(); ++i)
    c.heights[i] = double((i / c.grid.columns + i % c.grid.columns) % 2);
  expect_same_bits(c, "egg crate");
}

TEST(SurfaceDeterminism, Meshes) { expect_same_bits(as_mesh(hills(60, 70, 200, 1.3)), "mesh"); }

}  // namespace
}  // namespace krepl::test
