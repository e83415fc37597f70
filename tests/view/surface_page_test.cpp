// The shape that a surface's page shows: triangles on their patches, watertight, of
// the right area; tiles; faults in files.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>

#include "input/subdivision_file.hpp"
#include "krepl/surface.hpp"
#include "krepl/terrain.hpp"
#include "output/surface_file.hpp"
#include "output/surface_patch.hpp"
#include "view/surface/curve_points.hpp"
#include "view/surface/height_pyramid.hpp"
#include "view/surface/shape.hpp"
#include "view/surface/surface_page.hpp"
#include "view/surface/tile_encoding.hpp"
#include "view/surface/tile_tree.hpp"

namespace {

using namespace krepl;
using namespace krepl::view;
using Face = Shape::FaceKind;
constexpr double pi = std::numbers::pi;

std::shared_ptr<const Terrain> grid(std::size_t columns, std::size_t rows, std::vector<double> heights,
                                    Point first = {0, 0}) {
  Terrain::Grid g{columns, rows, first, 1, 1, Terrain::Split::rising};
  return std::make_shared<const Terrain>(Terrain::from_grid(g, std::move(heights)).value());
}

std::shared_ptr<const Terrain> hills(std::size_t side, Point first = {0, 0}) {
  std::vector<double> heights;
  for (std::size_t i = 0; i < side * side; ++i) heights.push_back(double((i * 2654435761u >> 7) % 9) / 2);
  return grid(side, side, heights, first);
}

/// By way of a file, as the page gets it.
input::SubdivisionFile surface_of(const std::shared_ptr<const Terrain>& terrain, double radius) {
  SurfaceOptions options;
  options.radius = radius;
  const auto surface = compute_surface(terrain, options);
  EXPECT_TRUE(surface) << surface.error().text();
  const std::string path =
      (std::filesystem::temp_directory_path() / ("krepl-page-" + std::to_string(::getpid()) + ".json")).string();
  const auto written = output::write_surface(path, *surface, {output::SurfaceFormat::Kind::json, "json"}, {});
  EXPECT_TRUE(written) << written.error().text();
  auto file = input::read_subdivision(path);
  std::filesystem::remove(path);
  EXPECT_TRUE(file) << file.error().text();
  return std::move(*file);
}

output::SurfacePatch patch_of(const Shape& shape, Shape::Index feature) {
  const Shape::Feature& f = shape.features[feature];
  return {Terrain::FeatureKind(f.count - 1), {f.at, f.count}, shape.radius};
}

double area_seen_from_above(const Shape& shape) {
  double sum = 0;
  for (const auto& t : shape.triangles) {
    const Point3 a = shape.vertices[t[0]], b = shape.vertices[t[1]], c = shape.vertices[t[2]];
    sum += ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
  }
  return sum;
}

void expect_on_patches(const Shape& shape, double max_error) {
  for (std::size_t f = 0; f < shape.faces.size(); ++f) {
    if (shape.faces[f].kind == Face::wall) continue;
    const output::SurfacePatch patch = patch_of(shape, shape.faces[f].feature);
    for (std::uint64_t t = shape.faces[f].first_triangle; t < shape.triangles_end(f); ++t) {
      const auto& c = shape.triangles[t];
      const Point3 corners[3] = {shape.vertices[c[0]], shape.vertices[c[1]], shape.vertices[c[2]]};
      for (const Point3 p : corners) {
        const double off = std::abs(patch.height(p.x, p.y) - p.z) * patch.normal(p).z;
        EXPECT_LT(off, 1e-7) << "face " << f;
      }
      EXPECT_LE(patch.deviation(corners[0], corners[1], corners[2]), 1.01 * max_error)
          << "face " << f << " kind " << int(shape.faces[f].kind) << " triangle " << t - shape.faces[f].first_triangle
          << " of " << shape.triangles_end(f) - shape.faces[f].first_triangle << " (" << corners[0].x << " "
          << corners[0].y << " " << corners[0].z << ") (" << corners[1].x << " " << corners[1].y << " " << corners[1].z
          << ") (" << corners[2].x << " " << corners[2].y << " " << corners[2].z << ") " << shape.radius;
    }
  }
}

/// Sides of one triangle only, by whether they lie along the outside.
std::size_t open_sides(const Shape& shape) {
  std::map<std::pair<Shape::Index, Shape::Index>, int> seen;
  for (const auto& t : shape.triangles)
    for (std::size_t i = 0; i < 3; ++i) ++seen[std::minmax(t[i], t[(i + 1) % 3])];
  std::size_t open = 0;
  for (const auto& [side, count] : seen) {
    EXPECT_LE(count, 2);
    open += count == 1;
  }
  return open;
}

TEST(SurfaceShape, FlatSquareHasTheAreaOfItsSumWithADisk) {
  const double radius = 0.5, error = 1e-4;
  const auto shape = surface_shape(surface_of(grid(4, 4, std::vector<double>(16, 7.0)), radius), error);
  ASSERT_TRUE(shape) << shape.error().text();
  const double wanted = 9 + 12 * radius + pi * radius * radius;
  EXPECT_NEAR(area_seen_from_above(*shape), wanted, 2 * pi * radius * error);
  EXPECT_LT(area_seen_from_above(*shape), wanted);
  expect_on_patches(*shape, error);
}

TEST(SurfaceShape, HillsAreWatertightAndOnTheirPatches) {
  for (const Point first : {Point{0, 0}, Point{4123450, 5312345}}) {
    for (const double radius : {0.3, 1.25, 6.0}) {
      const double error = radius / 200;
      const auto file = surface_of(hills(14, first), radius);
      const auto shape = surface_shape(file, error);
      ASSERT_TRUE(shape) << shape.error().text();
      expect_on_patches(*shape, error);
      std::size_t rim_chords = 0;
      for (std::size_t l = 0; l < shape->lines.size(); ++l)
        if (shape->lines[l].kind == Shape::LineKind::rim) rim_chords += shape->line_end(l) - shape->lines[l].first - 1;
      EXPECT_EQ(open_sides(*shape), rim_chords);
      EXPECT_EQ(shape->lines.size(), file.edges.size());
    }
  }
}

TEST(SurfaceShape, WallsFillTheStepBelowARim) {
  // A table above a floor: the floor's surface ends at the wall below the table's rim.
  std::vector<Point3> v;
  for (const auto& [x, z] : {std::pair{0.0, 0.0}, {4.0, 0.0}, {4.0, 5.0}, {8.0, 5.0}})
    for (const double y : {0.0, 4.0}) v.push_back({x, y, z});
  auto terrain = Terrain::from_triangles(v, {{0, 2, 1}, {1, 2, 3}, {4, 6, 5}, {5, 6, 7}, {2, 4, 3}, {3, 4, 5}});
  ASSERT_TRUE(terrain);
  const auto shape = surface_shape(surface_of(std::make_shared<const Terrain>(std::move(*terrain)), 1), 0.005);
  ASSERT_TRUE(shape) << shape.error().text();
  double area = 0;
  for (std::size_t f = 0; f < shape->faces.size(); ++f) {
    if (shape->faces[f].kind != Face::wall) continue;
    for (std::uint64_t t = shape->faces[f].first_triangle; t < shape->triangles_end(f); ++t) {
      const Point3 a = shape->vertices[shape->triangles[t][0]], b = shape->vertices[shape->triangles[t][1]],
                   c = shape->vertices[shape->triangles[t][2]];
      const double x = (b.y - a.y) * (c.z - a.z) - (b.z - a.z) * (c.y - a.y),
                   y = (b.z - a.z) * (c.x - a.x) - (b.x - a.x) * (c.z - a.z);
      area += std::hypot(x, y) / 2;
    }
  }
  // The table's rim is a stadium's half, 5 above 0; the floor's surface is 1 above its own ground in front of it, and
  // falls to 0 in a quarter of a cylinder at both ends.
  EXPECT_GT(area, 4 * 4);
  EXPECT_LT(area, 4 * 4 + 2 * 5 * 1 * pi / 2 + 1);
  EXPECT_NEAR(area_seen_from_above(*shape), 8 * 4 + 2 * (8 + 4) + pi, 0.05);
}

TEST(SurfaceShape, FaultsInFilesAreNamed) {
  const auto file = surface_of(hills(4), 1);
  const auto fails = [&](const std::string& what, auto&& spoil) {
    input::SubdivisionFile broken = file;
    spoil(broken);
    const auto shape = surface_shape(broken, 0.01);
    ASSERT_FALSE(shape);
    EXPECT_NE(shape.error().text().find(what), std::string::npos) << shape.error().text();
  };
  fails("half_edges[3]", [](auto& f) { f.half_edges[3].face = 1000000; });
  fails("half_edges[4]", [](auto& f) { f.half_edges[4].next = f.half_edges[5].next; });
  fails("not two half-edges", [](auto& f) { f.half_edges.pop_back(); });
  fails("faces[2]", [](auto& f) { f.faces[2].outer = f.faces[3].outer; });
  fails("no feature", [](auto& f) { f.faces[1].feature = 99999; });
  fails("vertices[5]", [](auto& f) { f.vertices[5].z = NAN; });
  fails("edges[7]", [](auto& f) { f.points[f.edges[7].first].x = INFINITY; });
  fails("radius", [](auto& f) { f.radius = -1; });
}

TEST(CurvePoints, CirclesAreCompletedFromThreePoints) {
  std::vector<Point3> given;
  for (int i = 0; i <= 4; ++i) given.push_back({std::cos(1.4 * i * pi / 4), std::sin(1.4 * i * pi / 4), 2});
  const auto points = curve_points(given, input::SubdivisionFile::Curve::circle, nullptr, nullptr, 1e-3);
  EXPECT_EQ(points.front(), given.front());
  EXPECT_EQ(points.back(), given.back());
  EXPECT_GT(points.size(), 20u);
  double length = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(std::hypot(points[i].x, points[i].y), 1, 1e-12);
    if (i > 0) {
      const double x = (points[i].x + points[i - 1].x) / 2, y = (points[i].y + points[i - 1].y) / 2;
      EXPECT_LE(1 - std::hypot(x, y), 1e-3);
      length += std::hypot(points[i].x - points[i - 1].x, points[i].y - points[i - 1].y);
    }
  }
  EXPECT_NEAR(length, 1.4 * pi, 5e-3);
}

TEST(CurvePoints, FewAreKeptOfWhatIsAlmostStraight) {
  std::vector<Point3> given;
  for (int i = 0; i <= 4; ++i) given.push_back({double(i), 1e-5 * i * (4 - i), 0});
  EXPECT_EQ(curve_points(given, input::SubdivisionFile::Curve::quartic, nullptr, nullptr, 1e-3).size(), 2u);
  EXPECT_EQ(curve_points(given, input::SubdivisionFile::Curve::quartic, nullptr, nullptr, 1e-6).size(), 5u);
}

TEST(TileTree, EveryFaceIsInOneLeafAndInItsBox) {
  const auto shape = surface_shape(surface_of(hills(40), 1), 0.005);
  ASSERT_TRUE(shape);
  const TileTree tree(*shape);
  ASSERT_GT(tree.tiles().size(), 4u);
  std::vector<int> seen(shape->faces.size());
  std::size_t lines = 0;
  for (const TileTree::Tile& tile : tree.tiles()) {
    if (tile.children > 0) continue;
    std::size_t triangles = 0;
    for (std::uint32_t k = tile.first; k < tile.last; ++k) {
      const std::uint32_t f = tree.order()[k];
      ++seen[f];
      for (std::uint64_t t = shape->faces[f].first_triangle; t < shape->triangles_end(f); ++t, ++triangles)
        for (const Shape::Index v : shape->triangles[t]) {
          const Point3 p = shape->vertices[v];
          EXPECT_TRUE(p.x >= tile.low.x && p.x <= tile.high.x && p.y >= tile.low.y && p.y <= tile.high.y &&
                      p.z >= tile.low.z && p.z <= tile.high.z);
        }
    }
    EXPECT_LE(triangles, TileTree::most_triangles);
    lines += tree.lines_of(tile).size();
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), std::ptrdiff_t(seen.size()));
  EXPECT_EQ(lines, shape->lines.size());
}

TEST(HeightPyramid, SamplesAnInclinedPlaneAndNothingBesideIt) {
  Shape shape;
  shape.vertices = {{0, 0, 1}, {8, 0, 9}, {0, 8, 5}};
  shape.triangles = {{0, 1, 2}};
  shape.faces = {{Face::cylinder, Shape::none, 0}};
  const HeightPyramid pyramid(shape, {0, 0}, 8, 3);
  for (int level = 0; level < 3; ++level) {
    const int side = HeightPyramid::cells << level;
    const double cell = 8.0 / side;
    for (int row = 0; row <= side; row += 5) {
      for (int column = 0; column <= side; column += 3) {
        const auto s = pyramid.sample(level, column, row);
        if (column + row > side) {
          EXPECT_TRUE(std::isnan(s.height));
          continue;
        }
        EXPECT_NEAR(s.height, 1 + column * cell + 0.5 * row * cell, 1e-5);
        EXPECT_EQ(s.cylinder, 255);
        EXPECT_EQ(s.sphere, 0);
      }
    }
  }
  EXPECT_TRUE(std::isnan(pyramid.sample(0, -1, 0).height));
}

TEST(SurfacePage, TheSameDataGiveTheSameBytes) {
  const auto terrain = hills(20);
  const auto file = surface_of(terrain, 1);
  const auto page = [&] {
    SurfacePageData data{"A <b>", "", "m", 0.01, surface_shape(file, 0.01).value(), {}};
    data.terrain = terrain_shape(*terrain, data.surface.origin);
    return render_surface_page(data);
  };
  const auto first = page(), second = page();
  if (!first) GTEST_SKIP() << first.error().text();
  EXPECT_EQ(first->html, second->html);
  EXPECT_NE(first->html.find("<title>A &lt;b&gt;</title>"), std::string::npos);
  for (const char* asking : {"<script src", "<link", "@import", "url("})
    EXPECT_EQ(first->html.find(asking), std::string::npos);
}

}  // namespace
