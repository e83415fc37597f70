// Measures of results against closed forms.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "krepl/network.hpp"
#include "krepl/surface.hpp"
#include "measure/surface_measure.hpp"
#include "measure/zone_measure.hpp"
#include "output/surface_file.hpp"
#include "support/temporary_file.hpp"

namespace krepl::measure {
namespace {

constexpr double pi = std::numbers::pi;

SurfaceMeasure of(const std::vector<Point3>& vertices, const std::vector<std::array<Terrain::Index, 3>>& triangles,
                  double radius, const char* format = "json") {
  const auto terrain = std::make_shared<const Terrain>(*Terrain::from_triangles(vertices, triangles));
  const auto surface = compute_surface(terrain, {radius});
  EXPECT_TRUE(surface);
  const test::TemporaryDirectory directory;
  const std::string file = directory / (std::string("surface.") + format);
  const auto known = output::find_surface_format(file, "");
  EXPECT_TRUE(known && output::write_surface(file, *surface, *known, {}));
  const bool layers = std::string(format) == "gpkg";
  EXPECT_EQ(layers, input::is_subdivision_gpkg(file));
  const auto read = [&]() -> Result<input::SubdivisionFile> {
    if (!layers) return input::read_subdivision(file);
    auto found = input::read_subdivision_gpkg(file);
    if (!found) return found.error();
    return std::move(found->file);
  }();
  EXPECT_TRUE(read) << read.error().text();
  const auto measured = measure_surface(*read);
  EXPECT_TRUE(measured);
  return *measured;
}

/// A rectangle of 6 x 4, level: the sum's upper side is that of a box with rounded edges.
TEST(SurfaceMeasure, LevelRectangle) {
  for (const char* format : {"json", "gpkg"}) {
    const SurfaceMeasure m = of({{0, 0, 5}, {6, 0, 5}, {6, 4, 5}, {0, 4, 5}}, {{0, 1, 2}, {0, 2, 3}}, 1.5, format);
    EXPECT_EQ(m.radius, 1.5);
    EXPECT_EQ(m.by_feature[2].count, 2u);
    EXPECT_EQ(m.by_feature[1].count, 4u);
    EXPECT_EQ(m.by_feature[0].count, 4u);
    EXPECT_NEAR(m.by_feature[2].area, 24, 1e-9);
    EXPECT_NEAR(m.by_feature[1].area, 20 * 1.5 * pi / 2, 1e-8);
    EXPECT_NEAR(m.by_feature[0].area, 2 * pi * 1.5 * 1.5, 1e-8);
    EXPECT_NEAR(m.by_feature[1].projected, 20 * 1.5, 1e-9);
    EXPECT_NEAR(m.by_feature[0].projected, pi * 1.5 * 1.5, 1e-8);
    EXPECT_NEAR(m.by_kind[2].length, 20 + 2 * pi * 1.5, 1e-8);
    EXPECT_EQ(m.by_kind[1].count, 0u);
    EXPECT_EQ(m.creases.count + m.bridges.count, 0u);
    EXPECT_LE(m.residual.value, 1e-12);
  }
}

/// Two slopes of 45 degrees that meet in an inner edge: the ball stays off it by R (sqrt 2 - 1).
TEST(SurfaceMeasure, InnerEdge) {
  const SurfaceMeasure m = of({{-9, 0, 9}, {0, 0, 0}, {9, 0, 9}, {-9, 20, 9}, {0, 20, 0}, {9, 20, 9}},
                              {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}}, 2);
  EXPECT_GT(m.creases.count, 0u);
  EXPECT_NEAR(m.creases.turn.value, pi / 2, 1e-9);
  EXPECT_NEAR(m.creases.depth.value, 2 * (std::sqrt(2.0) - 1), 1e-9);
  EXPECT_NEAR(m.creases.depth.at.x, 0, 1e-9);
  EXPECT_NEAR(m.creases.depth.at.z, 2 * std::sqrt(2.0), 1e-9);
}

/// A slot 2 wide under a ball of radius 3: only one of radius below 1 gets in.
TEST(SurfaceMeasure, Slot) {
  const SurfaceMeasure m =
      of({{-9, 0, 0}, {-1, 0, 0}, {-1, 20, 0}, {-9, 20, 0}, {1, 0, 0}, {9, 0, 0}, {9, 20, 0}, {1, 20, 0}},
         {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}, 3);
  EXPECT_GT(m.bridges.count, 0u);
  EXPECT_NEAR(m.narrowest_bridge.value, 1, 1e-9);
  EXPECT_NEAR(m.widest_bridge.value, 1, 1e-9);
  EXPECT_NEAR(m.bridges.turn.value, 2 * std::asin(1.0 / 3), 1e-9);
}

TEST(SurfaceMeasure, BrokenTopologyIsAnError) {
  input::SubdivisionFile file;
  file.radius = 1;
  file.vertices = {{0, 0, 0}};
  file.edges.push_back({input::SubdivisionFile::EdgeKind::seam, input::SubdivisionFile::Curve::line, {0, 0}, 0});
  EXPECT_FALSE(measure_surface(file));
}

TEST(ZoneMeasure, RingOfArcsAndHole) {
  input::ResultZone zone{3.0, {}, {}};
  input::ResultPolygon stadium;
  stadium.outer.pieces = {{false, {0, -3}, {}, {10, -3}},
                          {true, {10, -3}, {13, 0}, {10, 3}},
                          {false, {10, 3}, {}, {0, 3}},
                          {true, {0, 3}, {-3, 0}, {0, -3}}};
  stadium.holes.push_back({{{true, {6, 0}, {4, 0}, {6, 0}}}});
  zone.polygons.push_back(stadium);
  const ZoneMeasure m = measure_zone(zone);
  EXPECT_NEAR(m.area, 60 + 9 * pi - pi, 1e-12);
  EXPECT_NEAR(m.length, 20 + 6 * pi + 2 * pi, 1e-12);
  EXPECT_EQ(m.arcs, 3u);
  EXPECT_EQ(m.holes, 1u);
  EXPECT_NEAR(m.smallest_hole.value, pi, 1e-12);
  EXPECT_NEAR(m.shortest_piece.value, 2 * pi, 1e-12);
}

TEST(ProfileMeasure, ArcAndSegment) {
  using Kind = input::ProfileRecord::Kind;
  const ProfileMeasure m = measure_profile({{Kind::half_line, {0, -9}, {0, 2}, {}, false, 0, 1},
                                            {Kind::arc, {0, 2}, {2, 4}, {2, 2}, false, 0, 2},
                                            {Kind::segment, {2, 4}, {5, 4}, {}, true, 0, 3}});
  EXPECT_NEAR(m.arc_length, pi, 1e-12);
  EXPECT_NEAR(m.segment_length, 3, 1e-12);
  EXPECT_EQ(m.lowest, 2);
  EXPECT_EQ(m.highest, 4);
}

}  // namespace
}  // namespace krepl::measure
