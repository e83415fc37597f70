// Lines cut where they meet and put together between nodes: GEOS's union and merging of lines as a witness, by counts
// and length.
#include <geos_c.h>
#include <gtest/gtest.h>

#include "river/river_case.hpp"
#include "support/environment.hpp"
#include "support/wkt_file.hpp"

namespace krepl::test {
namespace {

void ignore(const char*, void*) {}

struct Answer {
  int lines = 0;
  double length = 0;
};

/// The union of the lines, cut at every meeting, then merged at all vertices where two of them end. Without a grid GEOS
/// may not see that a line crosses two that overlap in one point, and keeps both.
Answer merged_by_geos(const RiverLines& lines, double grid) {
  GEOSContextHandle_t handle = GEOS_init_r();
  GEOSContext_setNoticeMessageHandler_r(handle, ignore, nullptr);
  GEOSContext_setErrorMessageHandler_r(handle, ignore, nullptr);
  std::vector<GEOSGeometry*> parts;
  for (const auto& line : lines) {
    if (std::all_of(line.begin(), line.end(), [&](Point p) { return p == line.front(); })) continue;
    GEOSCoordSequence* sequence = GEOSCoordSeq_create_r(handle, unsigned(line.size()), 2);
    for (unsigned i = 0; i < line.size(); ++i) GEOSCoordSeq_setXY_r(handle, sequence, i, line[i].x, line[i].y);
    parts.push_back(GEOSGeom_createLineString_r(handle, sequence));
  }
  GEOSGeometry* all = GEOSGeom_createCollection_r(handle, GEOS_MULTILINESTRING, parts.data(), unsigned(parts.size()));
  GEOSGeometry* united = GEOSUnaryUnionPrec_r(handle, all, grid);
  GEOSGeometry* merged = GEOSLineMerge_r(handle, united);
  Answer answer;
  answer.lines = GEOSGetNumGeometries_r(handle, merged);
  GEOSLength_r(handle, merged, &answer.length);
  for (GEOSGeometry* g : {merged, united, all}) GEOSGeom_destroy_r(handle, g);
  GEOS_finish_r(handle);
  return answer;
}

void compare(const RiverLines& lines, double grid = 1e-7) {
  RiverOptions options;
  options.grid = grid;
  options.flow = RiverOptions::Flow::outlet;  // then only vertices where not just two ends meet are nodes
  const auto rivers = RiverNetwork::build(network_of(lines), options);
  if (!rivers) return;
  const Answer geos = merged_by_geos(lines, grid);
  double length = 0;
  for (const auto& reach : rivers->reaches()) length += reach.length;
  EXPECT_EQ(int(rivers->reaches().size()), geos.lines);
  EXPECT_NEAR(length, geos.length, 1e-6 * length);
}

TEST(LinesAgainstGeos, Random) {
  std::mt19937_64 random(seed());
  for (int k = 0; k < int(1500 * effort()); ++k) {
    compare(k % 2 == 0 ? grid_lines(random) : free_lines(random));
    if (HasFailure()) return;
  }
}

TEST(LinesAgainstGeos, RealLines) {
  const auto data = data_directory();
  if (!data) GTEST_SKIP() << "no directory of real data; set KREPL_DATA";
  int found = 0;
  for (const char* name : {"river_new_hope_epsg32617_mm.wkt", "river_walker_epsg32610_mm.wkt", "river_methow.wkt.gz",
                           "ne_10m_rivers_europe_epsg3035_m.wkt.gz", "roads_monaco_epsg32632_mm.wkt.gz",
                           "streets_tempe.wkt", "ne_10m_railroads_north_america.wkt.gz"}) {
    const auto path = *data / "vector" / name;
    if (!std::filesystem::exists(path)) continue;
    SCOPED_TRACE(name);
    RiverLines lines;
    for (const InputPart& part : read_wkt_file(path)) lines.push_back(part.vertices);
    compare(lines, std::string(name).starts_with("ne_10m_railroads") ? 1e-9 : 1e-7);  // degrees
    ++found;
  }
  if (found == 0) GTEST_SKIP() << "no files of lines in the directory of real data";
}

}  // namespace
}  // namespace krepl::test
