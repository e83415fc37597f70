// Parallel passes over real parts and a real elevation model, by the drop cutter at ten times the sampling.
#include <gtest/gtest.h>

#include <algorithm>

#include "input/terrain_reader.hpp"
#include "mill/cutter_check.hpp"
#include "mill/left_check.hpp"
#include "support/environment.hpp"

namespace krepl::test {
namespace {

struct RealPart {
  const char* file;
  double radius;  // relative to the longer side
};
const RealPart real_parts[] = {
    {"mesh/mount_rush.off.gz", 0.02}, {"mesh/demo.off", 0.15},          {"mesh/ktoolcav.off", 0.03},
    {"mesh/featuretype.off", 0.05},   {"mesh/failedinpycam.off", 0.04}, {"mesh/pycam-textbox.off", 0.01},
    {"mesh/ktoolcav.stl", 0.1},       {"dem/jacksboro.asc.gz", 0.004},  {"dem/jacksboro.asc.gz", 0.03},
};

/// The elevation model is in degrees: as cells of 92 m.
Result<std::shared_ptr<const Terrain>> in_metres(const Terrain& whole) {
  Terrain::Grid grid = whole.grid();
  grid.first = {0, 0}, grid.cell_x = grid.cell_y = 92;
  std::vector<double> heights;
  for (std::size_t k = 0; k < grid.columns * grid.rows; ++k)
    heights.push_back(whole.corners(Terrain::Index(6 * k)).point[0].z + whole.origin().z);
  auto made = Terrain::from_grid(grid, std::move(heights));
  if (!made) return made.error();
  return std::make_shared<const Terrain>(std::move(*made));
}

class RealParts : public testing::TestWithParam<RealPart> {};

TEST_P(RealParts, AreNotCutInto) {
  const auto data = data_directory();
  if (!data || !std::filesystem::exists(*data / GetParam().file)) GTEST_SKIP() << "no real data: set KREPL_DATA";
  input::TerrainRequest request;
  request.path = (*data / GetParam().file).string();
  const auto file = input::read_terrain(request);
  ASSERT_TRUE(file) << file.error().text();
  const auto made =
      file->terrain->is_grid() ? in_metres(*file->terrain) : Result<std::shared_ptr<const Terrain>>(file->terrain);
  ASSERT_TRUE(made);
  const std::shared_ptr<const Terrain> shared = *made;
  const Terrain& part = *shared;
  const double side = std::max(part.highest().x - part.lowest().x, part.highest().y - part.lowest().y);
  for (const double angle : {0.0, 90.0, 33.0}) {
    ParallelOptions o;
    o.tool.radius = side * GetParam().radius;
    // A hundredth of a millimetre on a part of 100 mm, with four decimals.
    o.accuracy.unit = std::pow(10.0, std::round(std::log10(side * 1e-6)));
    o.accuracy.tolerance = 100 * o.accuracy.unit;
    o.step_over = side / (8 * effort());
    o.angle = angle;
    o.zigzag = false;
    const auto milled = mill_parallel(shared, o);
    ASSERT_TRUE(milled) << milled.error().text();
    // Cutter locations of chords within the tolerance are about so far apart.
    const double spacing = std::sqrt(8 * o.accuracy.tolerance * o.tool.radius), feed = o.motion.feed;
    const double extent = std::max(part.extent(), o.tool.radius), floor = part.lowest().z + o.tool.radius;
    const PathCheck check =
        check_path(part, shared, milled->path, o.tool.radius, o.tool.radius + o.accuracy.tolerance, floor, spacing / 10,
                   10, [feed](const Move& m) { return m.kind != MoveKind::rapid && m.feed == feed; });
    EXPECT_GT(check.places, 1000u);
    EXPECT_LE(check.deepest, 1e-9 * extent)
        << "angle " << angle << " at " << check.deepest_at.x << " " << check.deepest_at.y;
    EXPECT_LE(check.highest, 1e-9 * extent)
        << "angle " << angle << " at " << check.highest_at.x << " " << check.highest_at.y << " " << check.highest_at.z;
  }
}

/// Slots of it end between walls that all but touch; no pass gets to their ends.
TEST(RealPart, KeepsTheScallopAtTheEndsOfGaps) {
  const auto data = data_directory();
  if (!data || !std::filesystem::exists(*data / "mesh/featuretype.off")) GTEST_SKIP() << "no real data: set KREPL_DATA";
  input::TerrainRequest request;
  request.path = (*data / "mesh/featuretype.off").string();
  const auto file = input::read_terrain(request);
  ASSERT_TRUE(file) << file.error().text();
  ParallelOptions o;
  o.tool.radius = 0.15, o.scallop = 0.02, o.angle = 45;
  const auto milled = mill_parallel(file->terrain, o);
  ASSERT_TRUE(milled) << milled.error().text();
  EXPECT_EQ(milled->report.open_places, 0u);
}

TEST_P(RealParts, AreNotCutIntoByWaterlines) {
  const auto data = data_directory();
  if (!data || !std::filesystem::exists(*data / GetParam().file)) GTEST_SKIP() << "no real data: set KREPL_DATA";
  input::TerrainRequest request;
  request.path = (*data / GetParam().file).string();
  const auto file = input::read_terrain(request);
  ASSERT_TRUE(file) << file.error().text();
  // A surface of 100,000 cells takes longer than all parts together.
  if (file->terrain->is_grid() || std::string(GetParam().file).find("mount_rush") != std::string::npos) GTEST_SKIP();
  const Terrain& part = *file->terrain;
  const double side = std::max(part.highest().x - part.lowest().x, part.highest().y - part.lowest().y);
  WaterlineOptions o;
  o.tool.radius = side * GetParam().radius;
  o.accuracy.unit = std::pow(10.0, std::round(std::log10(side * 1e-6)));
  o.accuracy.tolerance = 100 * o.accuracy.unit;
  o.step_down = (part.highest().z - part.lowest().z) / (5.5 * effort());
  const auto milled = mill_waterline(file->terrain, o);
  ASSERT_TRUE(milled) << milled.error().text();
  const double spacing = std::sqrt(8 * o.accuracy.tolerance * o.tool.radius), feed = o.motion.feed;
  const double extent = std::max(part.extent(), o.tool.radius);
  const PathCheck check = check_path(part, file->terrain, milled->path, o.tool.radius, o.tool.radius + o.accuracy.tolerance,
                                     -1e300, spacing / 10, 10, [feed](const Move& m) { return m.feed == feed; });
  PencilOptions v;
  v.tool = o.tool, v.accuracy = o.accuracy;
  if (const auto valleys = mill_pencil(file->terrain, v)) {
    const PathCheck beside = check_path(part, file->terrain, valleys->path, o.tool.radius, o.tool.radius + o.accuracy.tolerance,
                                        -1e300, spacing / 10, 10, [feed](const Move& m) { return m.feed == feed; });
    EXPECT_EQ(valleys->report.lifted_moves, 0u) << "pencil";
    EXPECT_LE(beside.deepest, 1e-9 * extent) << "pencil, at " << beside.deepest_at.x << " " << beside.deepest_at.y;
    EXPECT_LE(beside.highest, 1e-9 * extent) << "pencil, at " << beside.highest_at.x << " " << beside.highest_at.y;
  } else {
    EXPECT_NE(valleys.error().text().find("no valley"), std::string::npos) << valleys.error().text();
  }
  EXPECT_GT(check.places, 100u);
  EXPECT_EQ(milled->report.lifted_moves, 0u);
  EXPECT_LE(check.deepest, 1e-9 * extent) << "at " << check.deepest_at.x << " " << check.deepest_at.y;
  EXPECT_LE(check.highest, 1e-9 * extent) << "at " << check.highest_at.x << " " << check.highest_at.y << " " << check.highest_at.z;
}

/// Scallops of parallel, scallop and rest passes on small parts, by a simulation; roughing of them.
TEST(RealScallops, AreKept) {
  const auto data = data_directory();
  if (!data) GTEST_SKIP() << "no real data: set KREPL_DATA";
  struct Case {
    const char* file;
    double radius, scallop;
  };
  // The slots of the second are as wide as a ball of radius 2: a path keeps out of them.
  for (const Case& c : {Case{"mesh/demo.off", 0.5, 0.05}, Case{"mesh/failedinpycam.off", 1.95, 0.3}}) {
    if (!std::filesystem::exists(*data / c.file)) continue;
    input::TerrainRequest request;
    request.path = (*data / c.file).string();
    const auto file = input::read_terrain(request);
    ASSERT_TRUE(file) << file.error().text();
    const auto& part = file->terrain;
    const MillTool tool{c.radius, 0, {}};
    MillAccuracy accuracy;
    accuracy.unit = 1e-5, accuracy.tolerance = c.scallop / 8;
    ParallelOptions along;
    along.tool = tool, along.accuracy = accuracy, along.scallop = c.scallop;
    along.bottom = part->lowest().z + part->origin().z - 1.2 * c.radius;  // beside the part as well
    const auto passes = mill_parallel(part, along), scallop = mill_scallop(part, {tool, accuracy, {}, c.scallop, 20});
    ASSERT_TRUE(passes && scallop) << c.file;
    const double cell = c.radius / 8;
    for (const auto* milled : {&*passes, &*scallop}) {
      EXPECT_EQ(milled->report.open_places, 0u) << c.file;
      const LeftCheck check = check_left(part, milled->path, c.radius, c.scallop, cell);
      EXPECT_GT(check.dexels, 10000u);
      EXPECT_LE(check.worst, 1e-9 * part->extent()) << c.file << ": " << check.over << " at " << check.at.x << " " << check.at.y;
    }
    EXPECT_GT(check_left(part, passes->path, c.radius, 0.3 * c.scallop, cell).over, 100u) << "the witness sees less";
    RoughOptions rough;
    rough.tool = tool, rough.accuracy = accuracy, rough.step_over = 0.8 * c.radius, rough.step_down = c.radius;
    const auto roughed = mill_rough(part, rough);
    ASSERT_TRUE(roughed) << roughed.error().text();
    EXPECT_EQ(roughed->report.lifted_moves, 0u);
    const RestOptions rest{tool, accuracy, {}, c.scallop, 20, 2 * c.radius, -1};
    const auto rested = mill_rest(part, rest);
    ASSERT_TRUE(rested) << rested.error().text();
    EXPECT_EQ(rested->report.open_places, 0u);
    for (const auto* milled : {&*passes, &*scallop, &*roughed, &*rested}) {
      const PathCheck check = check_path(*part, part, milled->path, c.radius, c.radius + accuracy.tolerance, -1e300, c.radius / 20, 10,
                                         [](const Move&) { return false; });
      EXPECT_LE(check.deepest, 1e-9 * part->extent()) << c.file << " at " << check.deepest_at.x << " " << check.deepest_at.y;
    }
  }
}

TEST(RealCutters, DoNotCutIntoAPart) {
  const auto data = data_directory();
  const char* const name = "mesh/demo.off";
  if (!data || !std::filesystem::exists(*data / name)) GTEST_SKIP() << "no real data: set KREPL_DATA";
  input::TerrainRequest request;
  request.path = (*data / name).string();
  const auto file = input::read_terrain(request);
  ASSERT_TRUE(file) << file.error().text();
  const Terrain& part = *file->terrain;
  const double side = std::max(part.highest().x - part.lowest().x, part.highest().y - part.lowest().y), radius = side * 0.06;
  const Cutter cutters[] = {*Cutter::flat(2 * radius), *Cutter::bull_nose(2 * radius, radius / 3), *Cutter::cone(2 * radius, 70),
                            *Cutter::taper(2 * radius, 30, radius / 4)};
  for (const Cutter& cutter : cutters) {
    ParallelOptions o;
    o.tool.cutter = cutter, o.zigzag = false;
    o.accuracy.unit = std::pow(10.0, std::round(std::log10(side * 1e-6)));
    o.accuracy.tolerance = 200 * o.accuracy.unit;
    o.step_over = side / (5 * effort());
    WaterlineOptions w;
    w.tool = o.tool, w.accuracy = o.accuracy;
    w.step_down = (part.highest().z - part.lowest().z) / 2.5;
    const auto along = mill_parallel(file->terrain, o), around = mill_waterline(file->terrain, w);
    ASSERT_TRUE(along) << cutter.text() << ": " << along.error().text();
    ASSERT_TRUE(around) << cutter.text() << ": " << around.error().text();
    EXPECT_EQ(around->report.lifted_moves, 0u) << cutter.text();
    const double spacing = std::sqrt(8 * o.accuracy.tolerance * radius), feed = o.motion.feed;
    const auto is_cut = [feed](const Move& m) { return m.kind != MoveKind::rapid && m.feed == feed; };
    for (const bool passes : {true, false}) {
      const TipHeights heights(file->terrain, cutter, 0, passes ? part.lowest().z : -1e300);
      const TipCheck check =
          check_tip(part, heights, passes ? along->path : around->path, o.accuracy.tolerance, spacing / 10, 10, is_cut);
      EXPECT_GT(check.places, 500u);
      EXPECT_LE(check.deepest, 1e-9 * std::max(part.extent(), radius)) << cutter.text() << " at " << check.deepest_at.x << " " << check.deepest_at.y;
      EXPECT_EQ(check.far, 0u) << cutter.text() << " at " << check.far_at.x << " " << check.far_at.y << " " << check.far_at.z;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Mesh, RealParts, testing::ValuesIn(real_parts));

}  // namespace
}  // namespace krepl::test
