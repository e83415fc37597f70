// The subdivision of a surface from a GeoPackage is the one that the JSON has.
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "input/subdivision_file.hpp"
#include "krepl/surface.hpp"
#include "krepl/terrain.hpp"
#include "output/surface_file.hpp"

namespace {

using namespace krepl;
using input::SubdivisionFile;

class SubdivisionGpkg : public testing::Test {
 protected:
  void SetUp() override {
    std::vector<double> heights;
    for (int i = 0; i < 36; ++i) heights.push_back(double(i * 7 % 11));
    const Terrain::Grid grid{6, 6, {412000, 5312000}, 1, 1, Terrain::Split::rising};
    SurfaceOptions options;
    options.radius = 1.1;
    const auto surface =
        compute_surface(std::make_shared<const Terrain>(Terrain::from_grid(grid, heights).value()), options);
    ASSERT_TRUE(surface);
    stem_ = (std::filesystem::temp_directory_path() / ("krepl-gpkg-" + std::to_string(::getpid()))).string();
    for (const char* name : {"json", "gpkg"}) {
      const auto format = output::find_surface_format(stem_ + "." + name, "");
      ASSERT_TRUE(output::write_surface(stem_ + "." + name, *surface, *format, {}));
    }
  }
  void TearDown() override {
    for (const char* name : {".json", ".gpkg"}) std::filesystem::remove(stem_ + name);
  }
  std::string stem_;
};

TEST_F(SubdivisionGpkg, HasWhatTheJsonHas) {
  EXPECT_TRUE(input::is_subdivision_gpkg(stem_ + ".gpkg"));
  EXPECT_FALSE(input::is_subdivision_gpkg(stem_ + ".json"));
  const auto json = input::read_subdivision(stem_ + ".json");
  const auto gpkg = input::read_subdivision_gpkg(stem_ + ".gpkg");
  ASSERT_TRUE(json);
  ASSERT_TRUE(gpkg) << gpkg.error().text();
  const SubdivisionFile &a = *json, &b = gpkg->file;
  EXPECT_NEAR(b.radius, 1.1, 1e-8);
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  for (std::size_t v = 0; v < a.vertices.size(); ++v) EXPECT_EQ(a.vertices[v], b.vertices[v]);
  ASSERT_EQ(a.half_edges.size(), b.half_edges.size());
  for (std::size_t h = 0; h < a.half_edges.size(); ++h) {
    const auto &p = a.half_edges[h], &q = b.half_edges[h];
    EXPECT_TRUE(p.origin == q.origin && p.twin == q.twin && p.next == q.next && p.face == q.face && p.edge == q.edge)
        << h;
  }
  ASSERT_EQ(a.edges.size(), b.edges.size());
  for (std::size_t e = 0; e < a.edges.size(); ++e) {
    EXPECT_TRUE(a.edges[e].kind == b.edges[e].kind && a.edges[e].curve == b.edges[e].curve &&
                a.edges[e].feature == b.edges[e].feature);
    EXPECT_EQ(a.points[a.edges[e].first], b.points[b.edges[e].first]);
  }
  ASSERT_EQ(a.faces.size(), b.faces.size());
  for (std::size_t f = 0; f < a.faces.size(); ++f) {
    EXPECT_EQ(a.faces[f].feature, b.faces[f].feature);
    if (a.faces[f].feature == SubdivisionFile::none) continue;
    EXPECT_EQ(a.faces[f].outer, b.faces[f].outer);
    const auto &p = a.features[a.faces[f].feature], &q = b.features[b.faces[f].feature];
    ASSERT_EQ(p.count, q.count);
    for (std::size_t i = 0; i < std::size_t(p.count); ++i) EXPECT_EQ(p.at[i], q.at[i]);
  }
}

TEST_F(SubdivisionGpkg, FaultsAreNamed) {
  {
    const std::unique_ptr<GDALDataset> dataset(
        GDALDataset::Open((stem_ + ".gpkg").c_str(), GDAL_OF_VECTOR | GDAL_OF_UPDATE));
    ASSERT_TRUE(dataset);
    dataset->ExecuteSQL("UPDATE edges SET kind = 'crease' WHERE edge = 3", nullptr, nullptr);
  }
  const auto spoilt = input::read_subdivision_gpkg(stem_ + ".gpkg");
  ASSERT_FALSE(spoilt);
  EXPECT_NE(spoilt.error().text().find("edges, feature 4"), std::string::npos) << spoilt.error().text();
}

}  // namespace
