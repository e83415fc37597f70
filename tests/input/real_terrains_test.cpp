// Every raster and mesh of KREPL_DATA is read, with the numbers that its MANIFEST.md gives.
#include <gtest/gtest.h>

#include <cstdio>
#include <set>

#include "input/terrain_reader.hpp"
#include "model/terrain_window.hpp"
#include "support/environment.hpp"

namespace krepl::test {
namespace {

struct Known {
  const char* file;
  std::size_t triangles;  // left after cleaning
  std::size_t missing = 0, vertical = 0, border = 0, non_manifold = 0, repeated = 0, welded_cracks = 0;
};

// MANIFEST.md counts the triangles of cells with four samples only (st_helens 296186, hugo_site 4066; here those with
// three have one), and the edges of mount_rush with its 407 repeated triangles (862 and 1645).
const Known known_files[] = {
    {.file = "dem/jacksboro.asc.gz", .triangles = 275772},
    {.file = "dem/volcano.asc", .triangles = 10320},
    {.file = "dem/st_helens.asc.gz", .triangles = 296192, .missing = 4151},
    {.file = "dem/bigtujunga.asc.gz", .triangles = 1535664},
    {.file = "dem/mongon.asc", .triangles = 26912},
    {.file = "dem/dem.tif", .triangles = 26912},
    {.file = "dem/hugo_site.asc", .triangles = 4096, .missing = 2028},
    {.file = "dem/pre_runout.asc", .triangles = 18876, .missing = 122},
    {.file = "tin/st_helens_tin.off", .triangles = 20241, .border = 189},
    {.file = "mesh/mount_rush.stl.gz", .triangles = 15185, .border = 868, .non_manifold = 671, .repeated = 407},
    {.file = "mesh/mount_rush.off.gz", .triangles = 15185, .border = 868, .non_manifold = 671, .repeated = 407},
    {.file = "mesh/demo.off", .triangles = 1894, .border = 196},
    {.file = "mesh/ktoolcav.stl", .triangles = 4090, .vertical = 1214},
    {.file = "mesh/ktoolcav.off", .triangles = 4090, .vertical = 1214},
    {.file = "mesh/failedinpycam.stl", .triangles = 428, .vertical = 216},
    {.file = "mesh/failedinpycam.off", .triangles = 428, .vertical = 216},
    {.file = "mesh/pycam-textbox.stl", .triangles = 1444, .vertical = 724},
    {.file = "mesh/pycam-textbox.off", .triangles = 1444, .vertical = 724},
    // Its 576 border edges are cracks 1e-16 wide, which welding closes.
    {.file = "mesh/featuretype.STL", .triangles = 3476, .vertical = 1704, .welded_cracks = 288},
    {.file = "mesh/featuretype.off", .triangles = 3476, .vertical = 1704, .welded_cracks = 288},
};

class RealTerrains : public testing::Test {
 protected:
  void SetUp() override {
    data_ = data_directory();
    if (!data_ || !std::filesystem::is_directory(*data_ / "dem"))
      GTEST_SKIP() << "no real data: set KREPL_DATA to a directory with dem, tin and mesh";
  }
  Result<input::TerrainFile> read(const std::string& file, const std::string& to_crs = {}) const {
    input::TerrainRequest request;
    request.path = (*data_ / file).string(), request.to_crs = to_crs;
    return input::read_terrain(request);
  }
  std::optional<std::filesystem::path> data_;
};

/// Windows side by side hold each triangle as core at least once, and nothing else.
void expect_windows_cover(const Terrain& terrain) {
  const Point3 low = terrain.lowest(), high = terrain.highest();
  constexpr int sides = 7;
  std::set<Terrain::Index> seen;
  TerrainWindow window;
  const auto at = [](double from, double to, int i) { return i == sides ? to : from + (to - from) * i / sides; };
  for (int i = 0; i < sides; ++i)
    for (int j = 0; j < sides; ++j) {
      window.fill(terrain, {at(low.x, high.x, i), at(low.y, high.y, j)},
                  {at(low.x, high.x, i + 1), at(low.y, high.y, j + 1)});
      for (const auto& face : window.faces())
        if (face.core) seen.insert(face.feature);
    }
  EXPECT_EQ(seen.size(), terrain.triangle_count());
}

TEST_F(RealTerrains, CountsOfTheManifest) {
  for (const Known& known : known_files) {
    SCOPED_TRACE(known.file);
    if (!std::filesystem::exists(*data_ / known.file)) {
      std::printf("  %-26s is not there\n", known.file);
      continue;
    }
    const auto file = read(known.file);
    ASSERT_TRUE(file.ok()) << file.error().text();
    const Terrain& terrain = *file->terrain;
    const Terrain::Report& report = terrain.report();
    EXPECT_EQ(terrain.triangle_count(), known.triangles);
    EXPECT_EQ(report.missing_samples, known.missing);
    EXPECT_EQ(report.zero_area_triangles, 0u);
    EXPECT_EQ(report.repeated_triangles, known.repeated);
    EXPECT_EQ(report.vertical_triangles, known.vertical);
    EXPECT_EQ(report.border_edges, known.border);
    EXPECT_GE(report.welded_vertices, known.welded_cracks);
    EXPECT_EQ(report.non_manifold_edges, known.non_manifold);
    if (terrain.triangle_count() < 300000) expect_windows_cover(terrain);
    std::printf("  %-26s %8zu triangles, extent %g\n", known.file, terrain.triangle_count(), terrain.extent());
  }
}

TEST_F(RealTerrains, DegreesInAnArchive) {
  const std::string file = "dem/N42E001.hgt.zip";
  if (!std::filesystem::exists(*data_ / file)) GTEST_SKIP() << "no " << file;
  const auto refused = read(file);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().what, "coordinates are in degrees (WGS 84 (EPSG:4326)), not in a plane");
  const auto projected = read(file, "auto");
  ASSERT_TRUE(projected.ok()) << projected.error().text();
  EXPECT_EQ(projected->crs_name, "WGS 84 / UTM zone 31N (EPSG:32631)");
  EXPECT_GT(projected->terrain->triangle_count(), 2000000u);
  const double top = projected->terrain->highest().z + projected->terrain->origin().z;
  EXPECT_GT(top, 3050);
  EXPECT_LE(top, 3100);
}

}  // namespace
}  // namespace krepl::test
