// Scallop, rest and parallel passes over random small terrains of all families and over needles, by brute force: never
// in the part, cuts within the tolerance of it, and no scallop higher than asked for.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "mill/left_check.hpp"
#include "mill/path_check.hpp"
#include "support/environment.hpp"
#include "support/small_terrain.hpp"

namespace krepl::test {
namespace {

/// Level ground with thin pyramids on it, on a grid: all but vertical.
SmallTerrain needles(std::mt19937& random) {
  SmallTerrain c;
  c.grid.columns = 4 + random() % 5, c.grid.rows = 4 + random() % 5;
  c.heights.assign(c.grid.columns * c.grid.rows, 0);
  for (double& h : c.heights)
    if (random() % 5 == 0) h = 1 + double(random() % 16);
  c.radius = std::array{0.6, 0.8, 1.5, 3.0}[random() % 4];
  return c;
}

struct RandomCase {
  std::shared_ptr<const Terrain> part;
  SmallTerrain terrain;
  double scallop = 0;
  MillTool tool;
  MillAccuracy accuracy;
  std::string what;
};

/// Of any family, with radii at which the ball reaches over some cells; nothing if there is no triangle.
RandomCase any_case(std::mt19937& random, int k, double flatter = 1) {
  RandomCase c;
  const unsigned families = unsigned(SmallTerrainFamily::count), family = unsigned(k) % (families + 1);
  if (family == families) {
    c.terrain = needles(random), c.what = "needles";
  } else {
    std::vector<std::uint8_t> bytes(8 + random() % 60);
    for (auto& b : bytes) b = std::uint8_t(random());
    c.terrain = decode_small_terrain(SmallTerrainFamily(family), bytes), c.what = name(SmallTerrainFamily(family));
  }
  if (c.what == "steep")
    for (double& h : c.terrain.heights) h *= flatter;
  const auto made = terrain_of(c.terrain);
  if (!made) return c;
  c.part = *made;
  // A slot exactly as wide as the ball is one that no path keeps clear of.
  c.tool.radius = 0.987 * std::clamp(c.terrain.radius, c.part->extent() / 8, c.part->extent());
  c.scallop = c.tool.radius * std::array{0.08, 0.15, 0.3}[random() % 3];
  if (random() % 4 == 0) c.tool.allowance = c.tool.radius / 5;
  c.accuracy.unit = std::pow(10.0, std::floor(std::log10(c.scallop / 1600)));
  c.accuracy.tolerance = 200 * c.accuracy.unit;
  c.what += ", case " + std::to_string(k) + ", radius " + std::to_string(c.tool.radius) + ", scallop " +
            std::to_string(c.scallop) + ", allowance " + std::to_string(c.tool.allowance);
  return c;
}

void expect_near(const RandomCase& c, const ToolPath& path) {
  const double grown = c.tool.radius + c.tool.allowance, scale = std::max(c.part->extent(), grown),
               feed = MillMotion{}.feed;
  const double step = std::sqrt(8 * c.accuracy.tolerance * c.tool.radius) / 10;
  const PathCheck check =
      check_path(*c.part, c.part, path, grown, grown + c.accuracy.tolerance, -1e300, std::max(step, scale / 1000), 10,
                 [feed](const Move& m) { return m.kind != MoveKind::rapid && m.feed == feed; });
  EXPECT_GT(check.places, 20u) << c.what;
  EXPECT_LE(check.deepest, 1e-9 * scale) << c.what << " gouges at " << check.deepest_at.x << " " << check.deepest_at.y
                                         << " " << check.deepest_at.z << "\n"
                                         << c.terrain;
  // How near lines are is not proven; next to rims they may begin a few units too early.
  EXPECT_LE(check.highest, 0.25 * c.accuracy.tolerance) << c.what << " is too high at " << check.highest_at.x << " "
                                                        << check.highest_at.y << " " << check.highest_at.z << "\n"
                                                        << c.terrain;
}

double dexel_cell(const RandomCase& c) { return std::max(c.part->extent() / 40, c.tool.radius / 12); }

TEST(RandomScallopPasses, LeaveNoMoreThanTheScallop) {
  std::mt19937 random(seed());
  const int cases = int(21 * effort());
  int done = 0, told = 0;
  for (int k = 0; k < cases; ++k) {
    const RandomCase c = any_case(random, k, 0.1);
    if (!c.part) continue;
    const ScallopOptions o{c.tool, c.accuracy, {}, c.scallop, 20};
    const auto milled = mill_scallop(c.part, o);
    ASSERT_TRUE(milled) << c.what << ": " << milled.error().text() << "\n" << c.terrain;
    expect_near(c, milled->path);
    // Where the bottom of a valley is as sharp as a needle lines may not get there: that is told.
    ++done, told += milled->report.open_places > 0;
    if (milled->report.open_places > 0) continue;
    const double grown = c.tool.radius + c.tool.allowance;
    const LeftCheck check = check_left(c.part, milled->path, grown, c.scallop, dexel_cell(c));
    if (c.tool.allowance == 0) {
      EXPECT_LE(check.worst, 1e-9 * c.part->extent())
          << c.what << ": " << check.over << " of " << check.dexels << " at " << check.at.x << " " << check.at.y << "\n"
          << c.terrain;
    }
    if (HasFailure()) return;
  }
  EXPECT_GE(2 * done, cases);
  EXPECT_LE(10 * told, done);
}

TEST(RandomParallelPasses, LeaveNoMoreThanTheScallop) {
  std::mt19937 random(seed() + 2);
  const int cases = int(28 * effort());
  for (int k = 0; k < cases; ++k) {
    RandomCase c = any_case(random, k);
    if (!c.part) continue;
    c.tool.allowance = 0;
    ParallelOptions o;
    o.tool = c.tool, o.accuracy = c.accuracy, o.scallop = c.scallop;
    // So that the tip may go below the part's lowest place beside it.
    o.bottom = c.part->lowest().z + c.part->origin().z - 1.2 * c.tool.radius;
    o.angle = std::array{0.0, 90.0, 30.0, -77.3}[random() % 4];
    const auto milled = mill_parallel(c.part, o);
    ASSERT_TRUE(milled) << c.what << ": " << milled.error().text() << "\n" << c.terrain;
    EXPECT_EQ(milled->report.open_places, 0u) << c.what << ", angle " << o.angle << "\n" << c.terrain;
    const LeftCheck check = check_left(c.part, milled->path, c.tool.radius, c.scallop, dexel_cell(c));
    EXPECT_LE(check.worst, 1e-9 * c.part->extent()) << c.what << ", angle " << o.angle << ": " << check.over << " of "
                                                    << check.dexels << " at " << check.at.x << " " << check.at.y << "\n"
                                                    << c.terrain;
    if (HasFailure()) return;
  }
}

TEST(RandomRestPasses, LeaveNoMoreThanTheScallopAfterALargerBall) {
  std::mt19937 random(seed() + 1);
  const int cases = int(21 * effort());
  int done = 0;
  for (int k = 0; k < cases; ++k) {
    RandomCase c = any_case(random, k, 0.1);
    if (!c.part) continue;
    c.tool.allowance = 0;
    RestOptions o{c.tool, c.accuracy, {}, c.scallop, 20};
    o.after = c.tool.radius * std::array{1.3, 2.0, 4.0}[random() % 3],
    o.threshold = c.scallop * std::array{0.5, 1.0}[random() % 2];
    c.what += ", after " + std::to_string(o.after) + ", threshold " + std::to_string(o.threshold);
    const auto milled = mill_rest(c.part, o);
    if (!milled) {
      EXPECT_EQ(milled.error().code, ErrorCode::input) << c.what << ": " << milled.error().text() << "\n" << c.terrain;
      continue;
    }
    ++done;
    expect_near(c, milled->path);
    EXPECT_EQ(milled->report.open_places, 0u) << c.what << "\n" << c.terrain;
    const double cell = dexel_cell(c);
    StockOptions stock;
    stock.cell = cell;
    const auto empty = Simulation::run({}, *c.part, *Cutter::ball(1), stock);
    ASSERT_TRUE(empty);
    const Dexels dexels{empty->place(0, 0), cell, empty->columns(), empty->rows()};
    const std::vector<double> larger = eroded(c.part, o.after, o.after, dexels);
    const LeftCheck check =
        check_left(c.part, milled->path, c.tool.radius, c.scallop, cell, larger, 2 * cell * cell / c.tool.radius);
    EXPECT_LE(check.worst, 1e-9 * c.part->extent())
        << c.what << ": " << check.over << " of " << check.dexels << " at " << check.at.x << " " << check.at.y << "\n"
        << c.terrain;
    if (HasFailure()) return;
  }
  EXPECT_GE(3 * done, cases);
}

}  // namespace
}  // namespace krepl::test
