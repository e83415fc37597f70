// Triangles of surfaces against brute force: each corner, and places all over each triangle, are as far from the terrain as
// the radius, but for the deviation asked for; sides fit together.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "input/terrain_reader.hpp"
#include "kernel/orientation.hpp"
#include "model/terrain_window.hpp"
#include "output/surface_mesh.hpp"
#include "support/ball_oracle.hpp"
#include "support/environment.hpp"
#include "support/mesh_arrays.hpp"

namespace krepl::test {
namespace {

using Mesh = MeshArrays;
using Side = std::array<Mesh::Index, 2>;

Point3 between(Point3 a, Point3 b, Point3 c, double s, double t) {
  const double r = 1 - s - t;
  return {r * a.x + s * b.x + t * c.x, r * a.y + s * b.y + t * c.y, r * a.z + s * b.z + t * c.z};
}

/// All of a terrain's triangles, one after the other; those whose box is too far away are not looked at closely.
class NearestTriangle {
 public:
  explicit NearestTriangle(const Terrain& terrain) {
    const Point3 low = terrain.lowest(), high = terrain.highest();
    TerrainWindow window;
    window.fill(terrain, {low.x, low.y}, {high.x, high.y});
    std::set<Terrain::Index> seen;
    for (const auto& face : window.faces()) {
      if (face.core && seen.insert(face.feature).second) add(terrain.corners(face.feature));
    }
  }

  double distance(Point3 p) const {
    Long least = std::numeric_limits<Long>::infinity();
    double square = std::numeric_limits<double>::infinity();
    for (const Triangle& triangle : triangles_) {
      const double x = std::max({triangle.low.x - p.x, p.x - triangle.high.x, 0.0});
      const double y = std::max({triangle.low.y - p.y, p.y - triangle.high.y, 0.0});
      const double z = std::max({triangle.low.z - p.z, p.z - triangle.high.z, 0.0});
      if (x * x + y * y + z * z > square) continue;
      least = std::min(least, nearest_on(triangle.corners, {p.x, p.y, p.z}).distance);
      square = double(least * least) * (1 + 1e-12);
    }
    return double(least);
  }

 private:
  struct Triangle {
    Terrain::Corners corners;
    Point3 low, high;
  };
  void add(const Terrain::Corners& corners) {
    Point3 low = corners.point[0], high = low;
    for (const Point3& p : corners.point) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    triangles_.push_back({corners, low, high});
  }
  std::vector<Triangle> triangles_;
};

/// The mean length of the terrain's edges.
double mean_edge(const Terrain& terrain) {
  if (terrain.is_grid()) return (terrain.grid().cell_x + terrain.grid().cell_y) / 2;
  double sum = 0;
  std::size_t count = 0;
  for (Terrain::Index f = 0; f < terrain.feature_bound(); ++f) {
    if (terrain.feature_kind(f) != Terrain::FeatureKind::edge) continue;
    const auto c = terrain.corners(f);
    const Point3 a = c.point[0], b = c.point[1];
    sum += std::hypot(b.x - a.x, b.y - a.y, b.z - a.z);
    ++count;
  }
  return sum / double(count);
}

/// Every `stride`th triangle: corners, middles of sides and places inside.
void expect_near(const Surface& surface, const Mesh& mesh, double deviation, double max_error, std::size_t stride) {
  const double radius = surface.radius();
  const NearestTriangle nearest(surface.terrain());
  double corner = 0, inside = 0;
  Surface::Index corner_face = 0, inside_face = 0;
  std::size_t far = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += stride) {
    const Mesh::Triangle& t = mesh.triangles[i];
    const Point3 a = mesh.vertices[t.vertex[0]], b = mesh.vertices[t.vertex[1]], c = mesh.vertices[t.vertex[2]];
    for (const Point3 p : {a, b, c}) {
      const double off = std::fabs(nearest.distance(p) - radius);
      if (off > corner) corner = off, corner_face = t.face;
    }
    for (const auto& [s, v] : {std::array{1.0 / 3, 1.0 / 3}, {0.5, 0.0}, {0.5, 0.5}, {0.0, 0.5}, {0.7, 0.2}, {0.1, 0.2}}) {
      const double off = std::fabs(nearest.distance(between(a, b, c, s, v)) - radius);
      if (off > inside) inside = off, inside_face = t.face;
      far += off > max_error;
    }
  }
  const double tolerance = 1e-11 * std::max(radius, surface.terrain().extent());
  EXPECT_LE(corner, tolerance) << "corner in face " << corner_face;
  EXPECT_LE(inside, max_error) << "place in face " << inside_face << "; too far: " << far << " of "
                               << mesh.triangles.size();
  EXPECT_LE(inside, deviation + tolerance);
  EXPECT_LE(deviation, max_error);
}

/// Every side is one of two triangles, to and fro, but for those along rims, which are closed.
void expect_watertight(const Surface& surface, const Mesh& mesh) {
  const Subdivision& topology = surface.subdivision();
  std::set<Surface::Index> with_rim;
  for (Surface::Index h = 0; h < topology.half_edge_count(); ++h) {
    if (surface.edge(h / 2).kind == Surface::EdgeKind::rim) with_rim.insert(topology.face[h]);
  }
  std::map<Side, int> sides;
  for (const Mesh::Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++sides[{t.vertex[k], t.vertex[(k + 1) % 3]}];
  }
  std::vector<int> balance(mesh.vertices.size(), 0);
  std::size_t open_inside = 0, unbalanced = 0;
  for (const Mesh::Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Side side{t.vertex[k], t.vertex[(k + 1) % 3]};
      const auto other = sides.find({side[1], side[0]});
      if (other != sides.end() && other->second == sides[side]) continue;
      open_inside += with_rim.count(t.face) == 0;
      ++balance[side[0]];
      --balance[side[1]];
    }
  }
  for (const int b : balance) unbalanced += b != 0;
  EXPECT_EQ(open_inside, 0u);
  EXPECT_EQ(unbalanced, 0u);
}

/// What is told about the triangles before they are made.
void expect_sums(const output::SurfaceMesh& made, const Mesh& mesh) {
  EXPECT_EQ(made.triangle_count(), mesh.triangles.size());
  EXPECT_EQ(made.border().count() + made.inner_count(), mesh.vertices.size());
  Point3 low = mesh.vertices[mesh.triangles[0].vertex[0]], high = low;
  std::set<std::pair<Surface::Index, Mesh::Index>> points;
  std::size_t folded = 0;
  for (const Mesh::Triangle& t : mesh.triangles) {
    const Point3 a = mesh.vertices[t.vertex[0]], b = mesh.vertices[t.vertex[1]], c = mesh.vertices[t.vertex[2]];
    folded += kernel::orientation({a.x, a.y}, {b.x, b.y}, {c.x, c.y}) < 0;
    for (const Mesh::Index v : t.vertex) points.insert({t.face, v});
    for (const Point3 p : {a, b, c}) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  }
  EXPECT_EQ(made.points_count(), points.size());
  EXPECT_EQ(made.folded(), folded);
  EXPECT_EQ(made.lowest(), low);
  EXPECT_EQ(made.highest(), high);
}

void expect_right(const std::shared_ptr<const Terrain>& terrain, double radius, double share, std::size_t stride) {
  const auto surface = compute_surface(terrain, {radius});
  ASSERT_TRUE(surface.ok()) << surface.error().text();
  const auto made = output::SurfaceMesh::make(*surface, share * radius);
  ASSERT_TRUE(made.ok()) << made.error().text();
  const Mesh mesh(*made);
  ASSERT_FALSE(mesh.triangles.empty());
  expect_sums(*made, mesh);
  expect_near(*surface, mesh, made->deviation(), share * radius, stride);
  expect_watertight(*surface, mesh);
}

void expect_right(const SmallTerrain& c) {
  const auto terrain = terrain_of(c);
  ASSERT_TRUE(terrain.ok()) << terrain.error().text();
  for (const double share : {1e-2, 1e-3, 1e-4}) {
    SCOPED_TRACE(share);
    expect_right(*terrain, c.radius, share, 1);
  }
}

TEST(SurfaceMesh, Hills) {
  SmallTerrain c;
  c.grid.columns = 5, c.grid.rows = 4;
  c.heights = {0, 1, 0, 2, 1, 1, 3, 0, 0, 1, 0, 0, 2, 1, 0, 1, 0, 1, 0, 2};
  c.radius = 1.3;
  expect_right(c);
}

/// A plate high above another: the surface goes on below a rim, and valleys end at walls.
TEST(SurfaceMesh, PlateAboveAnother) {
  SmallTerrain c;
  c.is_grid = false;
  c.radius = 0.7;
  c.triangles = {{{{0, 0, 0}, {9, 0, 0}, {9, 8, 1}}},   {{{0, 0, 0}, {9, 8, 1}, {0, 8, 2}}},
                 {{{3, 2, 5}, {6, 2.3, 5.5}, {5, 5, 6}}}, {{{3, 2, 5}, {5, 5, 6}, {2.5, 4.5, 5.2}}}};
  expect_right(c);
}

struct File {
  const char* name;
  double edges;  ///< the radius, in mean lengths of edges
};
std::ostream& operator<<(std::ostream& out, const File& file) { return out << file.name << ", R = " << file.edges; }

class SurfaceMeshOfFile : public testing::TestWithParam<File> {};

TEST_P(SurfaceMeshOfFile, IsWithinTheDeviation) {
  const auto data = data_directory();
  if (!data || !std::filesystem::exists(*data / GetParam().name)) GTEST_SKIP() << "no real data: set KREPL_DATA";
  input::TerrainRequest request;
  request.path = (*data / GetParam().name).string();
  const auto file = input::read_terrain(request);
  ASSERT_TRUE(file.ok()) << file.error().text();
  expect_right(file->terrain, GetParam().edges * mean_edge(*file->terrain), 1e-3, 101);
}

INSTANTIATE_TEST_SUITE_P(, SurfaceMeshOfFile,
                         testing::Values(File{"dem/volcano.asc", 1}, File{"dem/volcano.asc", 10},
                                         File{"mesh/failedinpycam.off", 1}, File{"mesh/failedinpycam.off", 10},
                                         File{"mesh/featuretype.off", 1}, File{"mesh/featuretype.off", 10},
                                         File{"mesh/pycam-textbox.off", 1}, File{"mesh/pycam-textbox.off", 10}));

}  // namespace
}  // namespace krepl::test
