// Choice of a projection; that it is carried out is tested in tests/cli against GDAL's own programs.
#include <gtest/gtest.h>

#include "input/network_reader.hpp"
#include "input/projection.hpp"
#include "support/temporary_file.hpp"

namespace krepl::test {
namespace {

void expect_range(const std::vector<double>& longitudes, double west, double width) {
  input::LongitudeRange range = input::longitude_range(longitudes);
  EXPECT_NEAR(range.west, west, 0.051);
  EXPECT_NEAR(range.width, width, 0.11);
}

TEST(LongitudeRange, PlainRangesAreExact) {
  input::LongitudeRange range = input::longitude_range({9.01, 3.5, 7});
  EXPECT_EQ(range.west, 3.5);
  EXPECT_EQ(range.width, 9.01 - 3.5);
  EXPECT_EQ(input::longitude_range({-77.5}).width, 0);
}

TEST(LongitudeRange, AcrossTheDateLine) {
  expect_range({179, -178}, 179, 3);
  expect_range({-179.99, 179.99, 178}, 178, 2.01);
  expect_range({181, 179}, 179, 2);  // longitudes from 0 to 360
}

TEST(LongitudeRange, AroundTheWorld) {
  std::vector<double> all;
  for (int i = -180; i <= 180; ++i) all.push_back(i);
  EXPECT_GT(input::longitude_range(all).width, 358);
}

std::string chosen(const std::string& wkt, const std::string& crs) {
  TemporaryDirectory directory;
  Result<input::NetworkData> data = input::read_network({directory.write("in.wkt", wkt), "", "", crs, "auto"});
  return data.ok() ? data->notes.at(0) : data.error().text();
}

TEST(AutomaticProjection, UtmZones) {
  const std::string note = "note: coordinates projected to ";
  EXPECT_EQ(chosen("POINT (9 50)\n", "EPSG:4326"), note + "WGS 84 / UTM zone 32N (EPSG:32632)");
  EXPECT_EQ(chosen("POINT (-70 -33)\n", "EPSG:4326"), note + "WGS 84 / UTM zone 19S (EPSG:32719)");
  EXPECT_EQ(chosen("POINT (180 10)\n", "EPSG:4326"), note + "WGS 84 / UTM zone 1N (EPSG:32601)");
  EXPECT_EQ(chosen("POINT (179 10)\n", "EPSG:4326"), note + "WGS 84 / UTM zone 60N (EPSG:32660)");
  EXPECT_EQ(chosen("POINT (-180 10)\n", "EPSG:4326"), note + "WGS 84 / UTM zone 1N (EPSG:32601)");
  EXPECT_EQ(chosen("POINT (-79 36)\n", "EPSG:4269"), note + "NAD83 / UTM zone 17N (EPSG:26917)");
}

TEST(AutomaticProjection, WideAndPolarData) {
  const std::string note = "note: coordinates projected to Azimuthal equidistant around ";
  EXPECT_EQ(chosen("LINESTRING (0 50, 7 50)\n", "EPSG:4326"), note + "3.5 50");
  EXPECT_EQ(chosen("POINT (9 86)\n", "EPSG:4326"), note + "9 86");
}

TEST(AutomaticProjection, FromAnotherProjection) {
  EXPECT_EQ(chosen("POINT (4321000 3210000)\n", "EPSG:3035"),
            "note: coordinates projected to ETRS89 / UTM zone 32N (EPSG:25832)");
}

}  // namespace
}  // namespace krepl::test
