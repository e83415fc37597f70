// The vertices of surfaces of small terrains against those found in 60 digits by brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <random>

#include "exact_contacts.hpp"
#include "support/environment.hpp"
#include "support/surface_faults.hpp"

namespace krepl::test {
namespace {

using Index = Surface::Index;

std::vector<Vec> corners_of(const Terrain& terrain, Index feature) {
  const auto c = terrain.corners(feature);
  std::vector<Vec> all;
  for (int k = 0; k < c.count; ++k) all.push_back(Vec(c.point[std::size_t(k)]));
  return all;
}

class ExactComparison {
 public:
  ExactComparison(const Surface& surface, const SmallTerrain& c)
      : surface_(surface),
        topology_(surface.subdivision()),
        witness_(c),
        origin_(surface.terrain().origin()),
        scale_(std::max(c.radius, surface.terrain().extent())),
        radius_(c.radius),
        degree_(topology_.vertex_count, 0),
        on_rim_(topology_.vertex_count, false) {
    for (Index h = 0; h < topology_.half_edge_count(); ++h) {
      ++degree_[topology_.origin[h]];
      if (surface.edge(h / 2).kind == Surface::EdgeKind::rim) on_rim_[topology_.origin[h]] = true;
    }
  }

  void run() {
    for (Index e = 0; e < topology_.edge_count(); ++e) ends_touch(e);
    for (Index v = 0; v < topology_.vertex_count; ++v) known(v);
    for (const ContactPoint& p : witness_.points()) {
      if (p.certain) present(p.center);
    }
  }

 private:
  /// Ends of edges are at distance R from the features of the edge, and nothing is nearer.
  void ends_touch(Index e) {
    const auto points = surface_.curve(e, 3);
    for (const Point3 p : {points.front(), points.back()}) {
      const Vec center(p);
      EXPECT_GE(double((witness_.distance(center + Vec(origin_)) - radius_) / scale_), -1e-12)
          << "edge " << e << at(center);
      for (const Index f : surface_.edge(e).feature) {
        if (f == Surface::none) continue;
        const Real off = ExactContacts::distance(corners_of(surface_.terrain(), f), center) - radius_;
        EXPECT_LE(double(abs(off) / scale_), 1e-12) << "edge " << e << ", feature " << f << at(center);
      }
    }
  }

  /// Each vertex is one of those found by brute force, lies on a rim, closes a loop, or is held by terms of second
  /// order.
  void known(Index v) {
    if (on_rim_[v] || degree_[v] == 2) return;
    const Vec p = Vec(surface_.vertex(v)) + Vec(origin_);
    Real nearest = scale_;
    for (const ContactPoint& q : witness_.points()) nearest = std::min<Real>(nearest, length(q.center - p));
    if (nearest <= 1e-9 * scale_ || !witness_.rigid(p, 1e-9 * scale_)) return;
    ADD_FAILURE() << "vertex " << v << " is " << double(nearest) << " from the nearest true one" << at(p);
  }

  /// There is one vertex where one must be, and only one.
  void present(const Vec& q) {
    Real nearest = scale_;
    int near = 0;
    for (Index v = 0; v < topology_.vertex_count; ++v) {
      const Real off = length(Vec(surface_.vertex(v)) + Vec(origin_) - q);
      nearest = std::min(nearest, off);
      near += off <= 1e-9 * scale_;
    }
    EXPECT_LE(double(nearest / scale_), 1e-9) << "the nearest vertex to a true one" << at(q);
    EXPECT_LE(near, 1) << "vertices" << at(q);
  }

  static std::string at(const Vec& p) {
    char text[100];
    std::snprintf(text, sizeof text, " at (%.12g, %.12g, %.12g)", double(p.x), double(p.y), double(p.z));
    return text;
  }

  const Surface& surface_;
  const Subdivision& topology_;
  ExactContacts witness_;
  Point3 origin_;
  Real scale_, radius_;
  std::vector<int> degree_;
  std::vector<bool> on_rim_;
};

void expect_exact(const SmallTerrain& c) {
  SCOPED_TRACE(text(c));
  const auto surface = surface_within(c, 10);
  ASSERT_TRUE(surface) << surface.error().text();
  ExactComparison(*surface, c).run();
}

SmallTerrain grid(std::size_t columns, std::size_t rows, double radius, const std::function<double(int, int)>& z) {
  SmallTerrain c;
  c.grid.columns = columns, c.grid.rows = rows;
  c.radius = radius;
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t k = 0; k < columns; ++k) c.heights.push_back(z(int(k), int(r)));
  }
  return c;
}

TEST(SurfaceExact, EggCrate) {
  for (const double radius : {0.75, 1.0, 2.5}) {
    expect_exact(grid(4, 3, radius, [](int c, int r) { return (c + r) % 2 == 0 ? 1.0 : 0.0; }));
  }
}

TEST(SurfaceExact, NeedleOverAPlane) {
  for (const double radius : {0.75, 1.0, 2.5}) {
    expect_exact(grid(3, 3, radius, [](int c, int r) { return c == 1 && r == 1 ? 5.0 : 0.0; }));
  }
}

TEST(SurfaceExact, PitBetweenSlopes) {
  for (const double radius : {0.75, 2.0, 7.0}) {
    expect_exact(grid(4, 3, radius, [](int c, int r) { return c == 1 && r == 1 ? -3.0 : double(c + 2 * r); }));
  }
}

TEST(SurfaceExact, Valleys) {
  for (const double radius : {0.5, 1.25, 3.0}) {
    expect_exact(grid(4, 3, radius, [](int c, int r) { return std::abs(c - 2) + (r == 1 ? 0.0 : 1.0); }));
  }
}

SmallTerrain pyramid() {
  SmallTerrain c;
  c.is_grid = false;
  const Point3 apex{2, 2, 3}, a{0, 0, 0}, b{5, 1, 0}, d{4, 5, 1}, e{-1, 4, 0};
  c.triangles = {{a, b, apex}, {b, d, apex}, {d, e, apex}, {e, a, apex}};
  return c;
}

TEST(SurfaceExact, Pyramid) {
  SmallTerrain c = pyramid();
  for (const double radius : {0.5, 1.0, 2.0, 6.0}) {
    c.radius = radius;
    expect_exact(c);
  }
}

/// Borders inside: the surface has walls.
TEST(SurfaceExactOpen, PyramidWithGaps) {
  SmallTerrain c = pyramid();
  const auto& t = c.triangles;
  c.triangles = {t[0], t[2], {Point3{6, 0, 1}, Point3{8, 3, 4}, Point3{6, 5, 0}}};
  for (const double radius : {0.5, 1.0, 2.0, 6.0}) {
    c.radius = radius;
    expect_exact(c);
  }
}

/// Heights from a wide range: hardly any ties.
TEST(SurfaceExact, GenericGrids) {
  std::mt19937 random(static_cast<unsigned>(seed()));
  const int cases = int(8 * effort());
  for (int i = 0; i < cases; ++i) {
    const double radius = std::array{0.4, 0.75, 1.1, 1.6, 2.7, 6.1}[random() % 6];
    expect_exact(grid(3 + random() % 2, 3, radius, [&](int, int) { return double(random() % 1000) / 256; }));
  }
}

/// Few heights: ties everywhere.
TEST(SurfaceExactOpen, TiedGrids) {
  std::mt19937 random(static_cast<unsigned>(seed()));
  const int cases = int(8 * effort());
  for (int i = 0; i < cases; ++i) {
    const double radius = std::array{0.5, 0.75, 1.0, 1.25, 1.5, 2.5}[random() % 6];
    expect_exact(grid(3 + random() % 2, 3, radius, [&](int, int) { return double(random() % 3); }));
  }
}

}  // namespace
}  // namespace krepl::test
