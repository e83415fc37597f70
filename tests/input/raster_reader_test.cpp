// Reading rasters: where samples lie, which are missing, how cells are split, what is refused.
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "input/terrain_reader.hpp"
#include "ogr/message_capture.hpp"
#include "ogr/spatial_reference.hpp"
#include "support/temporary_file.hpp"

namespace krepl::test {
namespace {

constexpr double no_data = -9999;

/// What a test writes as a GeoTIFF of doubles.
struct Image {
  int columns = 3, rows = 2, bands = 1;
  std::vector<double> values;  // band by band, row by row from the upper left
  std::vector<double> transform{100, 10, 0, 220, 0, -10};
  std::string crs = {};
};

void write(const Image& image, const std::string& path, GDALDataType type = GDT_Float64) {
  ogr::initialise();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  const std::unique_ptr<GDALDataset> file(
      driver->Create(path.c_str(), image.columns, image.rows, image.bands, type, nullptr));
  if (!image.transform.empty()) file->SetGeoTransform(const_cast<double*>(image.transform.data()));
  if (!image.crs.empty()) file->SetSpatialRef(&*ogr::parse_crs(image.crs));
  for (int b = 1; b <= image.bands; ++b) {
    double* values = const_cast<double*>(image.values.data()) + (b - 1) * image.columns * image.rows;
    ASSERT_EQ(file->GetRasterBand(b)->RasterIO(GF_Write, 0, 0, image.columns, image.rows, values, image.columns,
                                               image.rows, GDT_Float64, 0, 0, nullptr),
              CE_None);
    file->GetRasterBand(b)->SetNoDataValue(no_data);
  }
}

class RasterReader : public testing::Test {
 protected:
  Result<input::TerrainFile> read(const Image& image, input::TerrainRequest request = {}) {
    request.path = directory_ / "in.tif";
    write(image, request.path);
    return input::read_terrain(request);
  }
  std::string fault(const Image& image, const input::TerrainRequest& request = {}) {
    const auto file = read(image, request);
    return file.ok() ? "read without error" : file.error().text();
  }
  std::string fault_of(const std::string& path, input::TerrainRequest request = {}) {
    request.path = path;
    const auto file = input::read_terrain(request);
    return file.ok() ? "read without error" : file.error().text();
  }
  /// Sample (column, row) in absolute coordinates; row 0 has the least y.
  static Point3 sample(const Terrain& t, std::size_t column, std::size_t row) {
    const auto corner = t.corners(Terrain::Index(6 * (row * t.grid().columns + column))).point[0];
    return {corner.x + t.origin().x, corner.y + t.origin().y, corner.z + t.origin().z};
  }
  TemporaryDirectory directory_;
};

TEST_F(RasterReader, SamplesLieAtPixelCentres) {
  const auto file = read({.values = {1, 2, 3, 4, 5, 6}, .crs = "EPSG:25832"});
  ASSERT_TRUE(file.ok()) << file.error().text();
  const Terrain& t = *file->terrain;
  EXPECT_TRUE(t.is_grid());
  EXPECT_EQ(t.triangle_count(), 4u);
  EXPECT_EQ(sample(t, 0, 0), (Point3{105, 205, 4}));
  EXPECT_EQ(sample(t, 2, 0), (Point3{125, 205, 6}));
  EXPECT_EQ(sample(t, 1, 1), (Point3{115, 215, 2}));
  EXPECT_EQ(file->crs_name, "ETRS89 / UTM zone 32N (EPSG:25832)");
  EXPECT_TRUE(file->notes.empty());
}

TEST_F(RasterReader, RowsAndColumnsInAnyDirection) {
  const auto south_up = read({.values = {1, 2, 3, 4, 5, 6}, .transform = {100, 10, 0, 200, 0, 10}});
  ASSERT_TRUE(south_up.ok()) << south_up.error().text();
  EXPECT_EQ(sample(*south_up->terrain, 0, 0), (Point3{105, 205, 1}));
  EXPECT_EQ(sample(*south_up->terrain, 2, 1), (Point3{125, 215, 6}));
  const auto mirrored = read({.values = {1, 2, 3, 4, 5, 6}, .transform = {130, -10, 0, 220, 0, -10}});
  ASSERT_TRUE(mirrored.ok()) << mirrored.error().text();
  EXPECT_EQ(sample(*mirrored->terrain, 0, 0), (Point3{105, 205, 6}));
  EXPECT_EQ(sample(*mirrored->terrain, 2, 1), (Point3{125, 215, 1}));
}

TEST_F(RasterReader, MissingSamplesAndSplits) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Image image{.columns = 3, .rows = 3, .values = {no_data, 0, 0, 0, 5, 1, 0, 0, nan}};
  const auto triangles = [&](std::optional<Terrain::Split> split) {
    input::TerrainRequest request;
    request.split = split;
    const auto file = read(image, request);
    EXPECT_EQ(file->terrain->report().missing_samples, 2u);
    return file->terrain->triangle_count();
  };
  EXPECT_EQ(triangles(std::nullopt), 6u);  // rising: the two corners that lack a sample lose one triangle each
  EXPECT_EQ(triangles(Terrain::Split::rising), 6u);
  EXPECT_EQ(triangles(Terrain::Split::falling), 4u);  // the diagonal starts where there is no sample: both go
  EXPECT_EQ(triangles(Terrain::Split::shorter), 6u);
}

TEST_F(RasterReader, BandsScalesAndFactors) {
  Image image{.bands = 2, .values = {1, 2, 3, 4, 5, 6, 10, 20, 30, 40, 50, 60}};
  auto file = read(image);
  ASSERT_TRUE(file.ok()) << file.error().text();
  EXPECT_EQ(file->notes, std::vector<std::string>{"note: band 1 of 2 is taken as heights; see --band"});
  EXPECT_EQ(sample(*file->terrain, 0, 0).z, 4);
  input::TerrainRequest request;
  request.band = 2, request.z_scale = 0.5;
  file = read(image, request);
  ASSERT_TRUE(file.ok()) << file.error().text();
  EXPECT_TRUE(file->notes.empty());
  EXPECT_EQ(sample(*file->terrain, 0, 0).z, 20);
  request.band = 3;
  EXPECT_EQ(fault(image, request), "there is no band 3; the bands are 1 to 2");
}

TEST_F(RasterReader, ABandsOwnScale) {
  const std::string path = directory_ / "scaled.tif";
  write({.values = {1, 2, 3, 4, 5, 6}}, path, GDT_Int16);
  {
    const std::unique_ptr<GDALDataset> file(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
    file->GetRasterBand(1)->SetScale(0.25);
    file->GetRasterBand(1)->SetOffset(100);
  }
  input::TerrainRequest request;
  request.path = path, request.z_scale = 2;
  const auto file = input::read_terrain(request);
  ASSERT_TRUE(file.ok()) << file.error().text();
  EXPECT_EQ(sample(*file->terrain, 0, 0).z, 2 * (4 * 0.25 + 100));
  EXPECT_EQ(file->notes, std::vector<std::string>{"note: the band's scale 0.25 and offset 100 are applied"});
}

TEST_F(RasterReader, WithoutGeoreference) {
  const auto file = read({.values = {1, 2, 3, 4, 5, 6}, .transform = {}});
  ASSERT_TRUE(file.ok()) << file.error().text();
  EXPECT_EQ(sample(*file->terrain, 0, 0), (Point3{0.5, 0.5, 4}));
  EXPECT_EQ(sample(*file->terrain, 2, 1), (Point3{2.5, 1.5, 3}));
  ASSERT_EQ(file->notes.size(), 1u);
  EXPECT_EQ(file->notes[0].substr(0, 50), "note: the file does not say where the raster lies;");
}

TEST_F(RasterReader, WhatIsRefused) {
  const std::vector<double> six{1, 2, 3, 4, 5, 6};
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(
      fault({.values = {1, 2, 3, 4, 5, -inf}}),
      "a height is infinite, column 2, row 1 (125 205); correct it, or mark it as no data: gdal_translate -a_nodata");
  EXPECT_EQ(fault({.values = std::vector<double>(6, no_data)}), "all samples of the grid are without data");
  EXPECT_EQ(fault({.values = {no_data, 1, no_data, 1, no_data, 1}}),
            "no triangle is left: no three neighbouring samples of a cell have data");
  EXPECT_EQ(fault({.columns = 6, .rows = 1, .values = six}), "a grid needs 2 x 2 samples or more, 6 x 1");
  EXPECT_EQ(fault({.values = six, .transform = {0, 10, 1, 0, 1, -10}}),
            "the raster is rotated or sheared: its rows do not follow x; resample it with gdalwarp");
  EXPECT_EQ(fault({.values = six, .transform = {10, 0.1, 0, 50, 0, -0.1}, .crs = "EPSG:4326"}),
            "coordinates are in degrees (WGS 84 (EPSG:4326)), not in a plane; project them with --to-crs EPSG:n, or "
            "with --to-crs auto");
  input::TerrainRequest request;
  request.to_crs = "auto";
  EXPECT_EQ(
      fault({.values = six}, request),
      "--to-crs needs to know the coordinate system of the data, and the file does not say; name it with --crs EPSG:n");
  request.to_crs = "EPSG:4258";
  EXPECT_EQ(fault({.values = six, .crs = "EPSG:25832"}, request),
            "--to-crs EPSG:4258 is not a plane coordinate system; name a projected one, or auto");
}

TEST_F(RasterReader, BadFiles) {
  EXPECT_EQ(fault_of(directory_ / "none.tif"), "no such file; check the name");
  EXPECT_EQ(fault_of(directory_.write("empty.asc", "")), "is empty");
  const std::string remedy = "; give a GDAL raster, or STL, OBJ, PLY or OFF";
  EXPECT_TRUE(fault_of(directory_.write("words.tif", "no raster at all\n")).ends_with(remedy));
  const std::string header = "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
  EXPECT_EQ(fault_of(directory_.write("good.asc", header + "1 2 3\n4 5 6\n")), "read without error");
  EXPECT_EQ(fault_of(directory_.write("short.asc", header + "1 2 3\n4 5\n")),
            "ends after 5 of 6 samples; the file seems to be cut off: get it again");
  EXPECT_EQ(fault_of(directory_.write("rows.asc", header + "1 2 3\n")),
            "ends after 3 of 6 samples; the file seems to be cut off: get it again");
  EXPECT_EQ(fault_of(directory_.write("nan.asc", header + "NODATA_value -1\n 4 nan 3\n4 5 6")), "read without error");
  write({.columns = 300, .rows = 300, .values = std::vector<double>(90000, 1)}, directory_ / "cut.tif");
  std::filesystem::resize_file(directory_ / "cut.tif", 300000);
  EXPECT_NE(fault_of(directory_ / "cut.tif"), "read without error");
}

TEST_F(RasterReader, DegreesAreResampledOnRequest) {
  // Heights 1000 * longitude + 2000 * latitude, which bilinear interpolation keeps in degrees.
  Image image{.columns = 40, .rows = 30, .values = {}, .transform = {9, 0.01, 0, 50, 0, -0.01}, .crs = "EPSG:4326"};
  for (int r = 0; r < 30; ++r)
    for (int c = 0; c < 40; ++c) image.values.push_back(1000 * (9.005 + 0.01 * c) + 2000 * (49.995 - 0.01 * r));
  input::TerrainRequest request;
  request.to_crs = "auto";
  const auto file = read(image, request);
  ASSERT_TRUE(file.ok()) << file.error().text();
  EXPECT_EQ(file->crs_name, "WGS 84 / UTM zone 32N (EPSG:32632)");
  ASSERT_EQ(file->notes.size(), 1u);
  EXPECT_EQ(file->notes[0].substr(0, 76),
            "note: resampled (bilinear) to WGS 84 / UTM zone 32N (EPSG:32632), cells 880.");
  const Terrain& t = *file->terrain;
  const std::unique_ptr<OGRCoordinateTransformation> back(
      OGRCreateCoordinateTransformation(&*ogr::parse_crs("EPSG:32632"), &*ogr::parse_crs("EPSG:4326")));
  std::size_t checked = 0;
  for (std::size_t s = 0; s < t.grid().columns * t.grid().rows; ++s) {
    Point3 p = sample(t, s % t.grid().columns, s / t.grid().columns);
    if (std::isnan(p.z)) continue;
    ASSERT_TRUE(back->Transform(1, &p.x, &p.y));
    // Half a pixel beyond the outermost samples the border's heights are repeated.
    if (p.x < 9.005 || p.x > 9.395 || p.y < 49.705 || p.y > 49.995) continue;
    ASSERT_NEAR(p.z, 1000 * p.x + 2000 * p.y, 1e-6);
    ++checked;
  }
  EXPECT_GT(checked, 800u);
}

TEST_F(RasterReader, NothingIsResampledToItsOwnSystem) {
  input::TerrainRequest request;
  request.to_crs = "EPSG:25832";
  auto file = read({.values = {1, 2, 3, 4, 5, 6}, .crs = "EPSG:25832"}, request);
  ASSERT_TRUE(file.ok()) << file.error().text();
  EXPECT_TRUE(file->notes.empty());
  EXPECT_EQ(sample(*file->terrain, 2, 1), (Point3{125, 215, 3}));
  // But a turned one is: a plane stays a plane.
  Image turned{.columns = 30, .rows = 30, .values = {}, .transform = {5e5, 6, 8, 5e6, 8, -6}, .crs = "EPSG:25832"};
  for (int r = 0; r < 30; ++r)
    for (int c = 0; c < 30; ++c)
      turned.values.push_back(2 * (6 * (c + 0.5) + 8 * (r + 0.5)) + 3 * (8 * (c + 0.5) - 6 * (r + 0.5)));
  file = read(turned, request);
  ASSERT_TRUE(file.ok()) << file.error().text();
  const Terrain& t = *file->terrain;
  EXPECT_GT(t.triangle_count(), 800u);
  for (std::size_t s = 0; s < t.grid().columns * t.grid().rows; ++s) {
    const Point3 p = sample(t, s % t.grid().columns, s / t.grid().columns);
    if (std::isnan(p.z)) continue;
    ASSERT_NEAR(p.z, 2 * (p.x - 5e5) + 3 * (p.y - 5e6), 1e-6);
  }
}

TEST_F(RasterReader, HolesStayHolesWhenResampled) {
  Image image{.columns = 20,
              .rows = 20,
              .values = std::vector<double>(400, 7),
              .transform = {9, 0.01, 0, 50, 0, -0.01},
              .crs = "EPSG:4326"};
  for (int r = 5; r < 12; ++r)
    for (int c = 6; c < 14; ++c) image.values[std::size_t(20 * r + c)] = no_data;
  input::TerrainRequest request;
  request.to_crs = "EPSG:25832";
  const auto file = read(image, request);
  ASSERT_TRUE(file.ok()) << file.error().text();
  EXPECT_GT(file->terrain->report().missing_samples, 40u);
  EXPECT_EQ(file->terrain->lowest().z + file->terrain->origin().z, 7);
  EXPECT_EQ(file->terrain->highest().z + file->terrain->origin().z, 7);
}

TEST_F(RasterReader, UndeclaredDegreesAreNoted) {
  const std::string path = directory_.write(
      "degrees.asc", "ncols 2\nnrows 2\nxllcorner -84.4\nyllcorner 36.7\ncellsize 0.0008333\n100 400\n200 300\n");
  input::TerrainRequest request;
  request.path = path;
  const auto file = input::read_terrain(request);
  ASSERT_TRUE(file.ok()) << file.error().text();
  ASSERT_EQ(file->notes.size(), 1u);
  EXPECT_NE(file->notes[0].find("look like degrees"), std::string::npos);
}

TEST_F(RasterReader, CancelEndsReading) {
  std::atomic<bool> cancel{true};
  Context context;
  context.cancel = &cancel;
  input::TerrainRequest request;
  request.path = directory_ / "in.tif";
  write({.values = {1, 2, 3, 4, 5, 6}}, request.path);
  const auto file = input::read_terrain(request, context);
  ASSERT_FALSE(file.ok());
  EXPECT_EQ(file.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace krepl::test
