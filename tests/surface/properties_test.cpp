// What moving, turning, mirroring and scaling a terrain does to its surface, and how the surface grows with R.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <functional>
#include <map>

#include "support/ball_oracle.hpp"
#include "support/environment.hpp"
#include "support/mesh_arrays.hpp"
#include "support/surface_faults.hpp"

namespace krepl::test {
namespace {

using Index = Surface::Index;

/// A mesh over a grid with its own diagonals and heights in sixteenths from a wide range: hardly any ties, so that
/// counts are the same whatever the rounding.
SmallTerrain generic_terrain() {
  const int columns = *rc::gen::inRange(2, 6), rows = *rc::gen::inRange(2, 6);
  SmallTerrain c;
  c.is_grid = false;
  std::vector<double> z;
  for (int i = 0; i < columns * rows; ++i)
    z.push_back(double(*rc::gen::resize(100, rc::gen::inRange(0, 64))) / 16 + double((i * 37) % 11) / 128);
  const auto at = [&](int i, int j) { return Point3{double(i), double(j), z[std::size_t(j * columns + i)]}; };
  for (int j = 0; j + 1 < rows; ++j) {
    for (int i = 0; i + 1 < columns; ++i) {
      const Point3 sw = at(i, j), se = at(i + 1, j), nw = at(i, j + 1), ne = at(i + 1, j + 1);
      if (*rc::gen::arbitrary<bool>())
        c.triangles.insert(c.triangles.end(), {{sw, se, nw}, {se, ne, nw}});
      else
        c.triangles.insert(c.triangles.end(), {{sw, se, ne}, {sw, ne, nw}});
    }
  }
  c.radius = *rc::gen::element(0.3, 0.7, 1.1, 1.9, 3.3, 7.7);
  return c;
}

struct Motion {
  const char* name;
  Point3 (*move)(Point3);
  double scale;
};

/// Exact on the coordinates of these terrains.
const Motion motions[] = {
    {"turn by 90 degrees",
     [](Point3 p) {
       return Point3{-p.y, p.x, p.z};
     },
     1},
    {"turn by 180 degrees",
     [](Point3 p) {
       return Point3{-p.x, -p.y, p.z};
     },
     1},
    {"mirror",
     [](Point3 p) {
       return Point3{-p.x, p.y, p.z};
     },
     1},
    {"mirror at the diagonal",
     [](Point3 p) {
       return Point3{p.y, p.x, p.z};
     },
     1},
    {"to UTM size",
     [](Point3 p) {
       return Point3{p.x + 500000, p.y + 4500000, p.z + 300};
     },
     1},
    {"double",
     [](Point3 p) {
       return Point3{2 * p.x, 2 * p.y, 2 * p.z};
     },
     2},
    {"shrink",
     [](Point3 p) {
       return Point3{0x1p-40 * p.x, 0x1p-40 * p.y, 0x1p-40 * p.z};
     },
     0x1p-40},
};

SmallTerrain moved(SmallTerrain c, const Motion& m) {
  for (auto& t : c.triangles) {
    for (Point3& p : t) p = m.move(p);
  }
  c.radius *= m.scale;
  return c;
}

/// Vertices, edges of each kind and faces of each kind.
std::map<std::string, int> counts(const Surface& s) {
  std::map<std::string, int> n;
  const auto& d = s.subdivision();
  n["vertices"] = int(d.vertex_count);
  for (Index e = 0; e < d.edge_count(); ++e) ++n["edges " + std::to_string(int(s.edge(e).kind))];
  for (Index f = 1; f < d.face_count(); ++f) {
    const Index feature = s.face_feature(f);
    ++n[feature == Surface::none ? "holes" : "faces " + std::to_string(s.terrain().corners(feature).count)];
  }
  return n;
}

std::vector<bool> on_rim(const Surface& s) {
  std::vector<bool> rim(s.subdivision().vertex_count, false);
  for (Index h = 0; h < s.subdivision().half_edge_count(); ++h) {
    if (s.edge(h / 2).kind == Surface::EdgeKind::rim) rim[s.subdivision().origin[h]] = true;
  }
  return rim;
}

Surface computed(const SmallTerrain& c) {
  auto s = surface_within(c, 10);
  if (!s) RC_FAIL(s.error().text());
  return std::move(*s);
}

void check(const char* what, const std::function<void()>& property) { EXPECT_TRUE(rc::check(what, property)); }

TEST(SurfaceProperties, Motions) {
  check("the same surface after a motion", [] {
    const SmallTerrain c = generic_terrain();
    const Motion& m = motions[*rc::gen::inRange<std::size_t>(0, std::size(motions))];
    RC_LOG() << text(c) << m.name << '\n';
    const SmallTerrain d = moved(c, m);
    const Surface a = computed(c), b = computed(d);
    RC_ASSERT(counts(a) == counts(b));
    // Every vertex has its image. On a wall its height is known to the square root of what its place is: both come from
    // coordinates rounded at the size of the largest one.
    const double scale = std::max(a.radius(), a.terrain().extent()) * m.scale, close = 1e-9 * scale;
    const double on_wall = close + std::sqrt(2 * b.radius() * 1e-15 * scale);
    const Point3 o = a.terrain().origin(), q = b.terrain().origin();
    const std::vector<bool> rim = on_rim(a);
    for (Index v = 0; v < a.subdivision().vertex_count; ++v) {
      const Point3 p = a.vertex(v), image = m.move({p.x + o.x, p.y + o.y, p.z + o.z});
      const double up = rim[v] ? on_wall : close, plane = close + 1e-15 * std::abs(image.y);
      bool found = false;
      for (Index w = 0; w < b.subdivision().vertex_count && !found; ++w) {
        const Point3 r = b.vertex(w);
        found = std::hypot(r.x + q.x - image.x, r.y + q.y - image.y) <= plane && std::abs(r.z + q.z - image.z) <= up;
      }
      if (!found) RC_LOG() << "vertex " << v << " has no image\n";
      RC_ASSERT(found);
    }
  });
}

TEST(SurfaceProperties, GrowsWithTheRadius) {
  check("monotone in R", [] {
    SmallTerrain c = generic_terrain();
    RC_LOG() << text(c) << '\n';
    const Surface less = computed(c);
    SmallTerrain larger = c;
    larger.radius = c.radius * *rc::gen::element(1 + 1e-9, 1.01, 2.0, 10.0);
    const Surface more = computed(larger);
    // Lifted by the difference of the radii at least: the larger ball contains the smaller one about the same point,
    // moved up.
    const BallOracle outer(triangles_of(c), less.terrain().origin(), larger.radius);
    for (Index e = 0; e < less.subdivision().edge_count(); ++e) {
      for (const Point3 p : less.curve(e, 3)) {
        RC_ASSERT(outer.height({p.x, p.y}) >= Long(p.z) + (larger.radius - c.radius) - 1e-9L * larger.radius);
      }
    }
    // And what the larger one says is its height is just that.
    for (Index e = 0; e < more.subdivision().edge_count(); ++e) {
      if (more.edge(e).kind == Surface::EdgeKind::rim) continue;
      for (const Point3 p : more.curve(e, 3))
        RC_ASSERT(std::fabs(outer.distance({p.x, p.y, p.z}) - larger.radius) <= 1e-9L * larger.radius);
    }
  });
}

/// A ball of radius b that rolls on the surface of radius a has its centre on the surface of radius a + b.
///
/// A point c of the surface for a + b that touches q: drawn towards q by b, it is at distance a from q, and nothing is
/// nearer. So the surface for a must pass there.
TEST(SurfaceProperties, FirstOneRadiusThenAnother) {
  check("a then b is a + b", [] {
    SmallTerrain first = generic_terrain();
    RC_LOG() << text(first) << '\n';
    const double share = *rc::gen::element(0.125, 0.25, 0.5, 0.75);
    SmallTerrain both = first;
    first.radius = both.radius * share;
    const Surface sum = computed(both);
    const Point3 origin = sum.terrain().origin();
    const BallOracle inner(triangles_of(first), origin, first.radius);
    const Long slack = 1e-9L * std::max(both.radius, sum.terrain().extent());
    for (Index e = 0; e < sum.subdivision().edge_count(); ++e) {
      const Surface::Edge edge = sum.edge(e);
      if (edge.kind == Surface::EdgeKind::rim) continue;
      for (const Point3 p : sum.curve(e, 3)) {
        for (const Index f : edge.feature) {
          const LongPoint q = nearest_on(sum.terrain().corners(f), {p.x, p.y, p.z}).at;
          const Long back = 1 - Long(share);
          const LongPoint c{p.x + back * (q.x - p.x), p.y + back * (q.y - p.y), p.z + back * (q.z - p.z)};
          RC_ASSERT(std::fabs(inner.distance(c) - first.radius) <= slack);
        }
      }
    }
  });
}

/// The same on the surface's own mesh, which is within a tolerance of the surface: from a point of the surface for a +
/// b, the mesh for a is b away.
TEST(SurfacePropertiesOpen, FirstOneRadiusThenAnotherOnTheMesh) {
  check("a then b is a + b on the mesh", [] {
    SmallTerrain first = generic_terrain();
    RC_LOG() << text(first) << '\n';
    const double share = *rc::gen::element(0.25, 0.5, 0.75);
    SmallTerrain both = first;
    first.radius = both.radius * share;
    const Surface sum = computed(both), a = computed(first);
    const auto mesh = output::SurfaceMesh::make(a, 2e-2 * first.radius);
    RC_ASSERT(mesh.ok());
    std::vector<SmallTerrain::Triangle> triangles;
    const MeshArrays arrays(*mesh);
    for (const auto& t : arrays.triangles)
      triangles.push_back({arrays.vertices[t.vertex[0]], arrays.vertices[t.vertex[1]], arrays.vertices[t.vertex[2]]});
    const BallOracle rolled(triangles, {}, both.radius - first.radius);
    for (Index e = 0; e < sum.subdivision().edge_count(); ++e) {
      if (sum.edge(e).kind == Surface::EdgeKind::rim) continue;
      const Point3 p = sum.curve(e, 3)[1];
      const Long off = rolled.distance({p.x, p.y, p.z}) - (both.radius - first.radius);
      if (std::fabs(off) > mesh->deviation())
        RC_LOG() << "off by " << double(off) << " at " << p.x << ' ' << p.y << ' ' << p.z << '\n';
      RC_ASSERT(std::fabs(off) <= mesh->deviation() * (1 + 1e-6));
    }
  });
}

}  // namespace
}  // namespace krepl::test
