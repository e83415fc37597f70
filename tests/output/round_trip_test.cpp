// What write_zones writes and read_zones reads back: the same pieces, bit for bit, and where each comes from.
#include <gtest/gtest.h>

#include <random>

#include "input/network_reader.hpp"
#include "input/result_file.hpp"
#include "krepl/zone.hpp"
#include "output/zone_curves.hpp"
#include "output/zone_file.hpp"
#include "support/environment.hpp"
#include "support/temporary_file.hpp"

namespace krepl::test {
namespace {

using input::ResultPiece;
using input::ResultRing;
using input::ResultZone;

std::vector<Zone> zones_of(std::shared_ptr<const Network> network, std::initializer_list<double> radii) {
  std::vector<Zone> zones;
  for (double radius : radii) {
    Result<Zone> zone = compute_zone(network, {radius});
    EXPECT_TRUE(zone.ok()) << zone.error().text();
    zones.push_back(std::move(*zone));
  }
  return zones;
}

std::shared_ptr<const Network> random_network() {
  std::mt19937_64 random(seed());
  std::uniform_real_distribution<double> place(0, 1000), step(-60, 60);
  Network::Builder builder;
  for (int i = 0; i < 60; ++i) {
    std::vector<Point> line = {{670000 + place(random), 3970000 + place(random)}};
    for (int k = i % 5; k > 0; --k) line.push_back({line.back().x + step(random), line.back().y + step(random)});
    builder.add_line(line, 100 + i);
  }
  Result<Network> network = std::move(builder).build();
  EXPECT_TRUE(network.ok());
  return std::make_shared<const Network>(std::move(*network));
}

/// The zone's pieces as a file with curves holds them.
std::vector<ResultPiece> expected_ring(const Zone& zone, std::uint32_t ring) {
  std::vector<ResultPiece> pieces;
  for (const output::CurveRun& run : output::ring_runs(zone, ring)) {
    for (std::size_t i = 0; i + 1 < run.points.size(); i += run.arc ? 2 : 1) {
      if (run.arc) {
        pieces.push_back({true, run.points[i], run.points[i + 1], run.points[i + 2]});
      } else {
        pieces.push_back({false, run.points[i], {}, run.points[i + 1]});
      }
    }
  }
  return pieces;
}

void expect_ring(const ResultRing& found, const std::vector<ResultPiece>& expected) {
  ASSERT_EQ(found.pieces.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(found.pieces[i].arc, expected[i].arc);
    EXPECT_EQ(found.pieces[i].start, expected[i].start);
    EXPECT_EQ(found.pieces[i].end, expected[i].end);
    if (expected[i].arc) {
      EXPECT_EQ(found.pieces[i].middle, expected[i].middle);
    }
  }
}

void expect_zone(const ResultZone& found, const Zone& zone) {
  ASSERT_EQ(found.polygons.size(), zone.polygon_count());
  for (std::uint32_t p = 0; p < zone.polygon_count(); ++p) {
    Zone::Polygon polygon = zone.polygon(p);
    expect_ring(found.polygons[p].outer, expected_ring(zone, polygon.outer));
    ASSERT_EQ(found.polygons[p].holes.size(), polygon.holes.size());
    for (std::size_t h = 0; h < polygon.holes.size(); ++h) {
      expect_ring(found.polygons[p].holes[h], expected_ring(zone, polygon.holes[h]));
    }
  }
}

std::vector<ResultZone> through_file(const std::string& name, std::span<const Zone> zones,
                                     const output::ZoneFileOptions& options = {}) {
  TemporaryDirectory directory;
  std::string path = directory / name;
  Result<output::ZoneFormat> format = output::find_zone_format(path, "");
  EXPECT_TRUE(format.ok());
  Result<output::ZoneFileReport> written = output::write_zones(path, zones, *format, options);
  EXPECT_TRUE(written.ok()) << written.error().text();
  Result<std::vector<ResultZone>> found = input::read_zones(path);
  EXPECT_TRUE(found.ok()) << found.error().text();
  return found.ok() ? *found : std::vector<ResultZone>{};
}

class CurveFormats : public testing::TestWithParam<const char*> {};

TEST_P(CurveFormats, KeepEveryBit) {
  std::vector<Zone> zones = zones_of(random_network(), {5, 17.25, 60});
  std::vector<ResultZone> found = through_file(GetParam(), zones);
  ASSERT_EQ(found.size(), zones.size());
  for (std::size_t i = 0; i < zones.size(); ++i) {
    expect_zone(found[i], zones[i]);
    if (found[i].radius) {
      EXPECT_EQ(*found[i].radius, zones[i].radius());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, CurveFormats, testing::Values("out.gpkg", "out.fgb", "out.wkt", "out.wkb"));

TEST(GeoPackage, PiecesLeadBackToTheInput) {
  std::shared_ptr<const Network> network = random_network();
  std::vector<Zone> zones = zones_of(network, {12});
  std::vector<ResultZone> found = through_file("out.gpkg", zones);
  ASSERT_EQ(found.size(), 1u);
  std::size_t checked = 0;
  for (const input::ResultPolygon& polygon : found[0].polygons) {
    for (const ResultPiece& piece : polygon.outer.pieces) {
      ASSERT_GE(piece.source_feature, 100);
      ASSERT_GE(piece.source_part, 0);
      auto part = static_cast<std::uint32_t>(piece.source_part);
      EXPECT_EQ(network->part_feature(part), piece.source_feature);
      // The named vertex is at distance R from an arc's points; a segment's piece runs beside the named segment.
      ASSERT_LT(static_cast<std::size_t>(piece.source_vertex), network->part(part).size());
      Point v = network->vertices()[network->part(part)[static_cast<std::size_t>(piece.source_vertex)]];
      v = {v.x + network->origin().x, v.y + network->origin().y};
      double distance = std::hypot(v.x - piece.start.x, v.y - piece.start.y);
      if (piece.arc) {
        EXPECT_NEAR(distance, 12, 1e-8);
      }
      EXPECT_GE(distance, 12 - 1e-8);
      ++checked;
    }
  }
  EXPECT_GT(checked, 100u);
}

TEST(GeoPackage, SeparatePolygonsAreOneZoneAgain) {
  std::vector<Zone> zones = zones_of(random_network(), {5, 9});
  output::ZoneFileOptions options;
  options.separate = true;
  std::vector<ResultZone> found = through_file("out.gpkg", zones, options);
  ASSERT_EQ(found.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) expect_zone(found[i], zones[i]);
}

class RealFiles : public testing::TestWithParam<const char*> {};

TEST_P(RealFiles, SurviveGeoPackageAndFlatGeobuf) {
  std::optional<std::filesystem::path> data = data_directory();
  if (!data) GTEST_SKIP() << "no real data; set KREPL_DATA to their directory";
  std::string path = (*data / "vector" / GetParam()).string();
  Result<input::NetworkData> read = input::read_network({path, "", "", "", ""});
  ASSERT_TRUE(read.ok()) << read.error().text();
  for (double fraction : {0.0005, 0.01}) {
    std::vector<Zone> zones = zones_of(read->network, {fraction * read->network->extent()});
    for (const char* name : {"out.gpkg", "out.fgb"}) {
      output::ZoneFileOptions options;
      options.pieces = false;
      std::vector<ResultZone> found = through_file(name, zones, options);
      ASSERT_EQ(found.size(), 1u);
      expect_zone(found[0], zones[0]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Vector, RealFiles,
                         testing::Values("river_new_hope_epsg32617_mm.wkt", "river_methow.wkt.gz", "Methow_Network.shp",
                                         "roads_monaco_epsg32632_mm.wkt.gz", "streets_tempe.wkt"));

}  // namespace
}  // namespace krepl::test
