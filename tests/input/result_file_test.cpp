// Reading zones back with their curves.
#include <gtest/gtest.h>

#include "input/result_file.hpp"
#include "support/temporary_file.hpp"

namespace krepl::test {
namespace {

using input::ResultPiece;
using input::ResultZone;

Result<std::vector<ResultZone>> read(const std::string& name, const std::string& text) {
  TemporaryDirectory directory;
  return input::read_zones(directory.write(name, text));
}

void expect_piece(const ResultPiece& piece, bool arc, Point start, Point end) {
  EXPECT_EQ(piece.arc, arc);
  EXPECT_EQ(piece.start, start);
  EXPECT_EQ(piece.end, end);
}

TEST(ReadZones, CompoundCurvesAndHoles) {
  auto zones =
      read("in.wkt",
           "MULTISURFACE (CURVEPOLYGON (COMPOUNDCURVE ((0 0, 10 0, 10 2), CIRCULARSTRING (10 2, 5 7, 0 2), (0 2, 0 0)),"
           " (4 1, 4 2, 5 2, 4 1)), CURVEPOLYGON (CIRCULARSTRING (20 0, 18 0, 20 0)))\n");
  ASSERT_TRUE(zones.ok()) << zones.error().text();
  ASSERT_EQ(zones->size(), 1u);
  const ResultZone& zone = zones->front();
  EXPECT_FALSE(zone.radius.has_value());
  EXPECT_EQ(zone.crs, "");
  ASSERT_EQ(zone.polygons.size(), 2u);
  const auto& outer = zone.polygons[0].outer.pieces;
  ASSERT_EQ(outer.size(), 4u);
  expect_piece(outer[0], false, {0, 0}, {10, 0});
  expect_piece(outer[1], false, {10, 0}, {10, 2});
  expect_piece(outer[2], true, {10, 2}, {0, 2});
  EXPECT_EQ(outer[2].middle, (Point{5, 7}));
  expect_piece(outer[3], false, {0, 2}, {0, 0});
  ASSERT_EQ(zone.polygons[0].holes.size(), 1u);
  EXPECT_EQ(zone.polygons[0].holes[0].pieces.size(), 3u);
  ASSERT_EQ(zone.polygons[1].outer.pieces.size(), 1u);
  expect_piece(zone.polygons[1].outer.pieces[0], true, {20, 0}, {20, 0});
  EXPECT_EQ(zone.polygons[1].outer.pieces[0].middle, (Point{18, 0}));
}

TEST(ReadZones, OnePerLineWithoutRadius) {
  auto zones = read("in.wkt", "POLYGON ((0 0, 1 0, 0 1, 0 0))\nPOLYGON ((0 0, 2 0, 0 2, 0 0))\n");
  ASSERT_TRUE(zones.ok());
  EXPECT_EQ(zones->size(), 2u);
}

TEST(ReadZones, FeaturesOfOneRadiusAreOneZone) {
  auto feature = [](const char* radius, const char* x) {
    return std::string(R"({"type":"Feature","properties":{"radius":)") + radius +
           R"(},"geometry":{"type":"Polygon","coordinates":[[[0,0],[)" + x + R"(,0],[0,1],[0,0]]]}})";
  };
  auto zones = read("in.geojson", R"({"type":"FeatureCollection","features":[)" + feature("5", "1") + "," +
                                      feature("7.5", "2") + "," + feature("5", "3") + "]}");
  ASSERT_TRUE(zones.ok()) << zones.error().text();
  ASSERT_EQ(zones->size(), 2u);
  EXPECT_EQ((*zones)[0].radius, 5);
  EXPECT_EQ((*zones)[0].polygons.size(), 2u);
  EXPECT_EQ((*zones)[1].radius, 7.5);
}

TEST(ReadZones, WhatIsNoZoneIsAnError) {
  EXPECT_EQ(read("in.wkt", "POINT (0 0)\n").error().text(),
            "geometry of type POINT is not a zone, line 1; give polygons");
  EXPECT_EQ(read("in.wkt", "POLYGON EMPTY\n").error().what, "has no zones");
  EXPECT_EQ(input::read_zones("/nowhere/at/all.gpkg").error().what, "no such file");
}

}  // namespace
}  // namespace krepl::test
