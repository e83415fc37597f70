// The surface of terrain (+) ball against brute force over all triangles, on terrains that are as degenerate as real ones.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <set>

#include "krepl/surface.hpp"
#include "support/environment.hpp"

namespace krepl::test {
namespace {

using Real = long double;

/// The highest ball over a place, and the features that touch it within `slack` of that height.
struct Highest {
  Real height = -std::numeric_limits<Real>::infinity();
  std::set<Terrain::Index> features;
};

class BruteForce {
 public:
  BruteForce(const Terrain& terrain, Real radius) : radius_(radius) {
    if (terrain.is_grid()) {
      for (const Terrain::Index f : in_use(terrain)) parts_.push_back({terrain.corners(f), f});
      return;
    }
    for (std::size_t f = 0; f < terrain.feature_bound(); ++f) {
      parts_.push_back({terrain.corners(Terrain::Index(f)), Terrain::Index(f)});
    }
  }

  /// From a place to a point, segment or triangle.
  static Real distance(const Terrain::Corners& c, Point3 p) {
    const auto& q = c.point;
    if (c.count == 1) return length(sub(p, q[0]));
    if (c.count == 2) {
      const Vector d = sub(q[1], q[0]), w = sub(p, q[0]);
      const Real s = std::clamp(dot(w, d) / dot(d, d), Real(0), Real(1));
      return length({w.x - s * d.x, w.y - s * d.y, w.z - s * d.z});
    }
    const Vector u = sub(q[1], q[0]), v = sub(q[2], q[0]), w = sub(p, q[0]);
    const Vector n{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    const Real uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), wu = dot(w, u), wv = dot(w, v), det = uu * vv - uv * uv;
    const Real s = (wu * vv - wv * uv) / det, t = (wv * uu - wu * uv) / det;
    if (s >= 0 && t >= 0 && s + t <= 1) return std::fabs(dot(w, n)) / length(n);
    Real least = std::numeric_limits<Real>::infinity();
    for (std::size_t i = 0; i < 3; ++i) least = std::min(least, distance({{q[i], q[(i + 1) % 3], {}}, 2}, p));
    return least;
  }
  Real distance(Point3 p) const {
    Real least = std::numeric_limits<Real>::infinity();
    for (const Part& part : parts_) least = std::min(least, distance(part.corners, p));
    return least;
  }

  Highest at(Point p, Real slack) const {
    std::vector<std::pair<Real, Terrain::Index>> found;
    Highest best;
    for (const Part& part : parts_) {
      const Real h = height(part.corners, p);
      if (!std::isfinite(h)) continue;
      found.push_back({h, part.feature});
      best.height = std::max(best.height, h);
    }
    for (const auto& [h, feature] : found) {
      if (h >= best.height - slack) best.features.insert(feature);
    }
    return best;
  }

 private:
  struct Vector {
    Real x, y, z;
  };
  static Vector sub(Point3 p, Point3 q) { return {Real(p.x) - q.x, Real(p.y) - q.y, Real(p.z) - q.z}; }
  static Real dot(Vector v, Vector w) { return v.x * w.x + v.y * w.y + v.z * w.z; }
  static Real length(Vector v) { return std::sqrt(dot(v, v)); }
  struct Part {
    Terrain::Corners corners;
    Terrain::Index feature;
  };
  /// Features of triangles without a missing corner; cells are split along the rising diagonal.
  static std::set<Terrain::Index> in_use(const Terrain& t) {
    std::set<Terrain::Index> features;
    const auto columns = t.grid().columns;
    const auto at = [&](std::size_t sample, unsigned kind) { return Terrain::Index(6 * sample + kind); };
    const auto known = [&](std::size_t sample) { return std::isfinite(t.corners(at(sample, 0)).point[0].z); };
    for (std::size_t r = 0; r + 1 < t.grid().rows; ++r) {
      for (std::size_t c = 0; c + 1 < columns; ++c) {
        const std::size_t s = r * columns + c, east = s + 1, north = s + columns, far = north + 1;
        if (!known(s) || !known(far)) continue;
        if (known(east)) features.insert({at(s, 0), at(east, 0), at(far, 0), at(s, 1), at(east, 2), at(s, 3), at(s, 4)});
        if (known(north)) features.insert({at(s, 0), at(north, 0), at(far, 0), at(s, 2), at(north, 1), at(s, 3), at(s, 5)});
      }
    }
    return features;
  }

  Real height(const Terrain::Corners& c, Point p) const {
    const Real none = -std::numeric_limits<Real>::infinity();
    const auto& q = c.point;
    if (c.count == 1) {
      const Real dx = Real(p.x) - q[0].x, dy = Real(p.y) - q[0].y, under = radius_ * radius_ - dx * dx - dy * dy;
      return under >= 0 ? q[0].z + std::sqrt(under) : none;
    }
    if (c.count == 2) {  // maximise over the places s of the contact: z(s) + sqrt(R^2 - |p - xy(s)|^2), which is concave
      Real low = 0, high = 1;
      const auto value = [&](Real s) {
        const Real x = q[0].x + s * (Real(q[1].x) - q[0].x) - p.x, y = q[0].y + s * (Real(q[1].y) - q[0].y) - p.y;
        const Real under = radius_ * radius_ - x * x - y * y;
        return under >= 0 ? q[0].z + s * (Real(q[1].z) - q[0].z) + std::sqrt(under) : -1e9L + under;
      };
      for (int i = 0; i < 200; ++i) {
        const Real a = low + (high - low) / 3, b = high - (high - low) / 3;
        (value(a) < value(b) ? low : high) = value(a) < value(b) ? a : b;
      }
      const Real s = (low + high) / 2;
      return s > 1e-12L && s < 1 - 1e-12L && value(s) > -1e8L ? value(s) : none;
    }
    const Real ux = Real(q[1].x) - q[0].x, uy = Real(q[1].y) - q[0].y, uz = Real(q[1].z) - q[0].z;
    const Real vx = Real(q[2].x) - q[0].x, vy = Real(q[2].y) - q[0].y, vz = Real(q[2].z) - q[0].z;
    Real nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    const Real size = std::sqrt(nx * nx + ny * ny + nz * nz) * (nz < 0 ? -1 : 1);
    if (nz == 0) return none;
    nx /= size, ny /= size, nz /= size;
    const Real x = p.x - radius_ * nx - q[0].x, y = p.y - radius_ * ny - q[0].y;  // the contact
    const Real det = ux * vy - uy * vx, s = (x * vy - y * vx) / det, t = (ux * y - uy * x) / det;
    if (s < 0 || t < 0 || s + t > 1) return none;
    return q[0].z + s * uz + t * vz + radius_ * nz;
  }

  Real radius_;
  std::vector<Part> parts_;
};

/// Everything that can be told without locating points: topology, labels, that along every edge the ball touches both
/// features and nothing is nearer, and that every feature that is clearly visible somewhere owns a face.
void expect_true(const std::shared_ptr<const Terrain>& terrain, double radius, unsigned seed, const std::string& name) {
  SCOPED_TRACE(name + ", radius " + std::to_string(radius));
  const auto surface = compute_surface(terrain, {radius});
  ASSERT_TRUE(surface) << surface.error().text();
  ASSERT_EQ(surface->validate(), std::nullopt);
  const double scale = std::max(radius, terrain->extent());
  const BruteForce brute(*terrain, radius);
  const auto& d = surface->subdivision();
  std::set<Terrain::Index> owners;
  for (Surface::Index f = 1; f < d.face_count(); ++f) owners.insert(surface->face_feature(f));
  for (Surface::Index e = 0; e < d.edge_count(); ++e) {
    const auto edge = surface->edge(e);
    for (const Point3 p : surface->curve(e, 4)) {
      EXPECT_GE(double(brute.distance(p)), radius - 1e-9 * scale) << "edge " << e << " at " << p.x << " " << p.y << " " << p.z;
      for (const Terrain::Index f : edge.feature) {
        if (f == Surface::none) continue;
        EXPECT_NEAR(double(BruteForce::distance(terrain->corners(f), p)), radius, 1e-9 * scale)
            << "edge " << e << " feature " << f << " at " << p.x << " " << p.y << " " << p.z;
      }
    }
  }
  std::mt19937 next(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const Point3 low = terrain->lowest(), high = terrain->highest();
  for (int i = 0; i < 200; ++i) {
    const Point p{low.x - radius + unit(next) * (high.x - low.x + 2 * radius),
                  low.y - radius + unit(next) * (high.y - low.y + 2 * radius)};
    const Highest h = brute.at(p, 1e-7 * scale);
    if (h.features.size() != 1) continue;
    EXPECT_TRUE(owners.contains(*h.features.begin())) << "feature " << *h.features.begin() << " at " << p.x << " " << p.y;
  }
}

std::shared_ptr<const Terrain> grid(std::size_t columns, std::size_t rows, const std::function<double(int, int)>& z,
                                    Point first = {0, 0}, double cell = 1) {
  std::vector<double> heights;
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < columns; ++c) heights.push_back(z(int(c), int(r)));
  }
  auto terrain = Terrain::from_grid({columns, rows, first, cell, cell, Terrain::Split::rising}, heights);
  EXPECT_TRUE(terrain) << terrain.error().text();
  return std::make_shared<const Terrain>(std::move(*terrain));
}

std::shared_ptr<const Terrain> mesh(std::vector<Point3> v, std::vector<std::array<Terrain::Index, 3>> t) {
  auto terrain = Terrain::from_triangles(std::move(v), std::move(t));
  EXPECT_TRUE(terrain) << terrain.error().text();
  return std::make_shared<const Terrain>(std::move(*terrain));
}

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

TEST(Surface, DegenerateGrids) {
  const auto each = [](const std::string& name, const std::function<double(int, int)>& z) {
    for (const double radius : {0.3, 1.0, 2.5, 10.0}) expect_true(grid(7, 6, z), radius, 1, name);
  };
  each("flat", [](int, int) { return 3.0; });
  each("slope", [](int c, int r) { return 2.0 * c - r; });
  each("ridge", [](int c, int) { return -std::abs(c - 3.0); });
  each("channel", [](int c, int) { return std::abs(c - 3.0); });
  each("three ridges", [](int c, int) { return c % 3 == 0 ? 1.0 : 0.0; });
  each("egg crate", [](int c, int r) { return (c + r) % 2 == 0 ? 1.0 : 0.0; });
  each("needle over a plane", [](int c, int r) { return c == 3 && r == 3 ? 40.0 : 0.0; });
  each("pit", [](int c, int r) { return c == 3 && r == 3 ? -40.0 : 0.0; });
  each("lake with a shore", [](int c, int r) { return std::max(0.0, c + r - 6.0); });
  each("pyramid", [](int c, int r) { return -double(std::max(std::abs(c - 3), std::abs(r - 2))); });
  each("hole", [](int c, int r) { return c == 3 && r == 3 ? missing : double((c * r) % 3); });
  each("islands", [](int c, int) { return c == 3 ? missing : 1.0; });
}

TEST(Surface, RandomIntegerGrids) {
  std::mt19937 next(static_cast<unsigned>(seed()));
  const int cases = int(60 * effort());
  for (int i = 0; i < cases; ++i) {
    const int most = 1 + int(next() % 4);
    const bool holes = next() % 3 == 0;
    const double radii[] = {0.3, 0.5, 1, 1.5, 2, 3, 7};
    const auto t = grid(3 + next() % 4, 3 + next() % 4, [&](int c, int r) {
      return holes && c + r > 0 && next() % 9 == 0 && c > 1 ? missing : double(next() % unsigned(most + 1));
    });
    expect_true(t, radii[next() % 7], unsigned(next()), "random grid " + std::to_string(i));
  }
}

TEST(Surface, Meshes) {
  for (const double radius : {0.2, 0.5, 1.0, 3.0}) {
    expect_true(mesh({{0, 0, 0}, {3, 0, 1}, {1, 2, 0.5}}, {{0, 1, 2}}), radius, 2, "one triangle");
    expect_true(mesh({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}},
                     {{4, 5, 6}, {4, 6, 7}, {0, 2, 1}, {0, 3, 2}, {0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5}, {2, 3, 7},
                      {2, 7, 6}, {3, 0, 4}, {3, 4, 7}}),
                radius, 3, "box");
    expect_true(mesh({{0, 0, 0}, {4, 0, 0}, {2, 3, 0}, {1, 1, 2}, {3, 1.5, 2}, {2, -1, 2.5}}, {{0, 1, 2}, {3, 4, 5}}),
                radius, 4, "one above the other");
  }
}

/// The counter-example to theorem 4.5.4: the last semi-krepl meets the others in a loop and an arc (mission.md, errata).
TEST(Surface, CounterExample) {
  std::vector<Point3> v{{0, 0, 0},        {1, 10, 0},        {-1, 10, 0},      {-0.70, 5, -0.3}, {-0.80, 4.8, -0.4},
                        {-0.80, 5.2, -0.4}, {-0.76, 5, 4},     {-12, 10, -8},    {-3, -12, -8}};
  const std::size_t left = v.size();
  for (std::size_t i = 3; i < left; ++i) v.push_back({-v[i].x, v[i].y, v[i].z});
  // A, B, Q, Q2, Q3, N, F, G on the left: 0, 2, 3 .. 8; on the right 0, 1, 9 .. 14.
  std::vector<std::array<Terrain::Index, 3>> t{{0, 1, 2}, {0, 8, 14}};
  for (const bool right : {false, true}) {
    const Terrain::Index b = right ? 1 : 2, o = right ? 6 : 0, a = 0;
    const Terrain::Index q = 3 + o, q2 = 4 + o, q3 = 5 + o, n = 6 + o, f = 7 + o, g = 8 + o;
    using Triangle = std::array<Terrain::Index, 3>;
    for (const Triangle tri : {Triangle{a, b, q}, {a, q, q2}, {q, b, q3}, {q, n, q2}, {q, q3, n}, {q2, n, q3}, {b, f, q3},
                               {q3, f, q2}, {q2, f, g}, {g, a, q2}}) {
      t.push_back(tri);
    }
  }
  expect_true(mesh(v, t), 1, 5, "counter-example");
}

TEST(Surface, FarFromTheOriginAndScaled) {
  const auto z = [](int c, int r) { return double((c * 7 + r * 5) % 4); };
  const auto near = grid(8, 8, z), far = grid(8, 8, z, {500000.5, 5400000.25});
  const auto large = grid(8, 8, [&](int c, int r) { return 1024 * z(c, r); }, {0, 0}, 1024);
  const auto a = compute_surface(near, {1.5}), b = compute_surface(far, {1.5}), c = compute_surface(large, {1.5 * 1024});
  ASSERT_TRUE(a && b && c);
  for (const auto* other : {&*b, &*c}) {
    EXPECT_EQ(a->subdivision().vertex_count, other->subdivision().vertex_count);
    EXPECT_EQ(a->subdivision().edge_count(), other->subdivision().edge_count());
    EXPECT_EQ(a->subdivision().face_count(), other->subdivision().face_count());
  }
}

/// Strips that are R long and an edge wide, and borders whose rims lie in one line: they take few cells nevertheless.
TEST(Surface, RadiusFarAboveTheExtent) {
  std::mt19937 next(11);
  const auto rough = grid(20, 16, [&](int, int) { return double(next() % 1024) / 128; });
  for (const double extents : {1.5, 3.0, 10.0, 100.0}) {
    const double radius = extents * rough->extent();
    expect_true(rough, radius, 9, "rough");
    const auto surface = compute_surface(rough, {radius});
    ASSERT_TRUE(surface);
    EXPECT_LT(surface->counters().cells, 100 * rough->triangle_count()) << extents << " extents";
    EXPECT_LT(surface->subdivision().edge_count(), rough->triangle_count()) << extents << " extents";
  }
}

TEST(Surface, SameFromAnyNumberOfThreads) {
  std::mt19937 next(7);
  const auto t = grid(120, 110, [&](int, int) { return double(next() % 6); });
  Context one, three;
  one.threads = 1;
  three.threads = 3;
  const auto a = compute_surface(t, {1.25}, one), b = compute_surface(t, {1.25}, three);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->validate(), std::nullopt);
  EXPECT_EQ(a->subdivision().next, b->subdivision().next);
  EXPECT_EQ(a->subdivision().face, b->subdivision().face);
  for (Surface::Index v = 0; v < a->subdivision().vertex_count; ++v) ASSERT_EQ(a->vertex(v), b->vertex(v));
}

TEST(Surface, RefusesBadRadius) {
  const auto t = grid(3, 3, [](int, int) { return 0.0; });
  for (const double radius :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e-20}) {
    const auto s = compute_surface(t, {radius});
    ASSERT_FALSE(s);
    EXPECT_EQ(s.error().code, ErrorCode::usage);
  }
}

}  // namespace
}  // namespace krepl::test
