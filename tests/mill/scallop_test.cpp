// Passes at a constant scallop, and rest passes, by brute force: never in the part, within the tolerance of it, and nothing left that is
// higher than the scallop above what the ball can reach.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "mill/left_check.hpp"
#include "mill/path_check.hpp"
#include "mill/threads_check.hpp"
#include "support/environment.hpp"

namespace krepl::test {
namespace {

/// A roof of 50 degrees, a dome and a bowl on level ground, 20 wide.
std::shared_ptr<const Terrain> roof_dome_and_bowl() {
  const std::size_t n = 81;
  const double cell = 0.25;
  std::vector<double> heights;
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i) {
      const double x = double(i) * cell - 10, y = double(j) * cell - 10;
      const double dome = 36 - (x - 4) * (x - 4) - (y + 4) * (y + 4), bowl = (x + 4) * (x + 4) + (y + 4) * (y + 4);
      double z = y > 2 ? 8 - 1.2 * std::abs(y - 6) : 1;
      if (dome > 0) z = std::max(z, std::sqrt(dome) - 2);
      if (bowl < 16) z = 1 + 6 - std::sqrt(52 - bowl);
      heights.push_back(z);
    }
  auto grid = Terrain::from_grid({n, n, {0, 0}, cell, cell, Terrain::Split::rising}, heights);
  return grid ? std::make_shared<const Terrain>(std::move(*grid)) : nullptr;
}

/// The block of scripts/make-part: a pocket with vertical walls, a slot, letters, a rib, a dome.
std::shared_ptr<const Terrain> made_block() {
  const std::string file = testing::TempDir() + "/krepl-scallop-part.off";
  const std::string command = "python3 -B '" + std::string(KREPL_SOURCE_DIR) + "/scripts/make-part' '" + file + "' >/dev/null";
  if (std::system(command.c_str()) != 0) return nullptr;
  std::ifstream in(file);
  std::string word;
  std::size_t vertices = 0, faces = 0, none = 0;
  in >> word >> vertices >> faces >> none;
  std::vector<Point3> points(vertices);
  for (Point3& p : points) in >> p.x >> p.y >> p.z;
  std::vector<std::array<Terrain::Index, 3>> triangles(faces);
  for (auto& t : triangles) in >> none >> t[0] >> t[1] >> t[2];
  std::remove(file.c_str());
  auto part = Terrain::from_triangles(std::move(points), std::move(triangles));
  return in && part ? std::make_shared<const Terrain>(std::move(*part)) : nullptr;
}

/// No cut below the part, none farther above it than the tolerance.
void expect_near(const std::shared_ptr<const Terrain>& part, const ToolPath& path, const MillTool& tool, const MillAccuracy& accuracy,
                 double step, const std::string& what) {
  const double grown = tool.radius + tool.allowance, scale = std::max(part->extent(), tool.radius), feed = MillMotion{}.feed;
  const PathCheck check = check_path(*part, part, path, grown, grown + accuracy.tolerance, -1e300, step, 3,
                                     [feed](const Move& m) { return m.feed == feed; });
  EXPECT_LE(check.deepest, 1e-9 * scale) << what << " gouges at " << check.deepest_at.x << " " << check.deepest_at.y << " "
                                         << check.deepest_at.z;
  EXPECT_LE(check.highest, 1e-9 * scale) << what << " is too high at " << check.highest_at.x << " " << check.highest_at.y << " "
                                         << check.highest_at.z;
}

TEST(ScallopPasses, LeaveNoMoreThanTheScallopOnSlopesDomesAndBowls) {
  const auto part = roof_dome_and_bowl();
  ASSERT_NE(part, nullptr);
  ScallopOptions o;
  o.tool.radius = 1.5, o.scallop = 0.12;
  const auto milled = mill_scallop(part, o);
  ASSERT_TRUE(milled) << milled.error().text();
  EXPECT_EQ(milled->report.open_places, 0u);
  expect_near(part, milled->path, o.tool, o.accuracy, 0.1, "roof, dome and bowl");
  const LeftCheck check = check_left(part, milled->path, o.tool.radius, o.scallop, 0.15);
  EXPECT_GT(check.dexels, 10000u);
  EXPECT_LE(check.worst, 1e-9 * part->extent()) << check.over << " of " << check.dexels << " at " << check.at.x << " " << check.at.y;
  // The witness sees less than half of it.
  EXPECT_GT(check_left(part, milled->path, o.tool.radius, 0.5 * o.scallop, 0.15).over, 300u);
  std::printf("worst %g, %zu lines, %.0f cut, %zu passes and %zu more\n", check.worst, milled->report.lines,
              milled->report.cutting_length, milled->report.passes, milled->report.extra_passes);
}

TEST(ScallopPasses, LeaveNoMoreThanTheScallopOnTheMadeBlock) {
  const auto part = made_block();
  if (!part) GTEST_SKIP() << "python3 is not there";
  ScallopOptions o;
  o.tool.radius = 3, o.scallop = 0.5;
  for (const double allowance : {0.0, 0.2}) {
    o.tool.allowance = allowance, o.scallop += allowance;
    const auto milled = mill_scallop(part, o);
    ASSERT_TRUE(milled) << milled.error().text();
    EXPECT_EQ(milled->report.open_places, 0u);
    EXPECT_EQ(milled->report.lifted_moves, 0u);
    expect_near(part, milled->path, o.tool, o.accuracy, 0.8, "made block");
    if (allowance > 0) continue;
    const LeftCheck check = check_left(part, milled->path, o.tool.radius, o.scallop, 0.5);
    EXPECT_LE(check.worst, 1e-9 * part->extent()) << check.over << " of " << check.dexels << " at " << check.at.x << " " << check.at.y;
    EXPECT_GT(check_left(part, milled->path, o.tool.radius, 0.5 * o.scallop, 0.5).over, 500u);
  }
}

TEST(ScallopPasses, AreTheSameForAnyNumberOfThreads) {
  const auto part = roof_dome_and_bowl();
  ASSERT_NE(part, nullptr);
  ScallopOptions o;
  o.tool.radius = 3, o.scallop = 1;
  expect_same_from_any_threads([&](const Context& context) { return mill_scallop(part, o, context); });
}

TEST(ScallopPasses, RefuseWhatHasNoMeaning) {
  const auto part = roof_dome_and_bowl();
  ASSERT_NE(part, nullptr);
  ScallopOptions o;
  o.tool.radius = 1.5;
  for (const double scallop : {0.0, -1.0, 0.019, 0.8, std::nan("")}) {
    o.scallop = scallop;
    const auto milled = mill_scallop(part, o);
    ASSERT_FALSE(milled) << scallop;
    EXPECT_EQ(milled.error().code, ErrorCode::usage);
  }
  o.scallop = 0.1, o.valley_angle = 180;
  EXPECT_FALSE(mill_scallop(part, o));
  RestOptions r;
  r.tool.radius = 1.5, r.scallop = 0.1;
  for (const double after : {0.0, 1.5, 1.0}) {
    r.after = after;
    EXPECT_FALSE(mill_rest(part, r)) << after;
  }
  r.after = 3, r.threshold = 1.6;
  EXPECT_FALSE(mill_rest(part, r));
  r.threshold = 0.001;
  EXPECT_FALSE(mill_rest(part, r));
}

/// After a larger ball that has been everywhere, and only where it has left something.
TEST(RestPasses, TakeWhatALargerBallLeaves) {
  const auto part = roof_dome_and_bowl();
  ASSERT_NE(part, nullptr);
  RestOptions o;
  o.tool.radius = 0.75, o.after = 2, o.scallop = 0.15, o.threshold = 0.1;
  const auto milled = mill_rest(part, o);
  ASSERT_TRUE(milled) << milled.error().text();
  EXPECT_EQ(milled->report.open_places, 0u);
  expect_near(part, milled->path, o.tool, o.accuracy, 0.1, "rest");

  const double cell = 0.15;
  StockOptions stock;
  stock.cell = cell;
  const auto empty = Simulation::run({}, *part, *Cutter::ball(1), stock);
  ASSERT_TRUE(empty);
  const Dexels dexels{empty->place(0, 0), cell, empty->columns(), empty->rows()};
  const std::vector<double> larger = eroded(part, o.after, o.after, dexels), smaller = eroded(part, o.tool.radius, o.tool.radius, dexels);
  // Between places where the larger ball was dropped it has been lower than the raster tells.
  const double slack = 2 * cell * cell / o.tool.radius;
  const LeftCheck check = check_left(part, milled->path, o.tool.radius, o.scallop, cell, larger, slack);
  EXPECT_LE(check.worst, 1e-9) << check.over << " of " << check.dexels << " at " << check.at.x << " " << check.at.y;
  // Without the path more is left.
  ToolPath none;
  none.start = milled->path.start;
  EXPECT_GT(check_left(part, none, o.tool.radius, o.scallop, cell, larger, slack).over, 500u);

  // Each place of a cut is near a dexel where the larger ball has left more than the threshold.
  const double near = 0.6;
  std::vector<char> rest(dexels.columns * dexels.rows);
  const auto far = std::int64_t(near / cell);
  for (std::size_t d = 0; d < rest.size(); ++d) {
    if (!(larger[d] - smaller[d] > o.threshold)) continue;
    for (std::int64_t y = -far; y <= far; ++y)
      for (std::int64_t x = -far; x <= far; ++x) {
        const std::int64_t c = std::int64_t(d % dexels.columns) + x, r = std::int64_t(d / dexels.columns) + y;
        if (c >= 0 && r >= 0 && c < std::int64_t(dexels.columns) && r < std::int64_t(dexels.rows))
          rest[std::size_t(r) * dexels.columns + std::size_t(c)] = 1;
      }
  }
  const auto drop = DropCutter::build(part, o.tool.radius);
  const Point3 origin = part->origin();
  std::size_t places = 0, beside = 0;
  walk(milled->path, 0.1, 1, [&](Point3 p, const Move& m) {
    if (m.feed != o.motion.feed) return;
    const auto contact = drop->at({p.x - origin.x, p.y - origin.y});
    const double c = std::round((contact.point.x + origin.x - dexels.first.x) / cell),
                 r = std::round((contact.point.y + origin.y - dexels.first.y) / cell);
    if (c < 0 || r < 0 || c >= double(dexels.columns) || r >= double(dexels.rows)) return;
    ++places, beside += !rest[std::size_t(r) * dexels.columns + std::size_t(c)];
  });
  EXPECT_GT(places, 500u);
  EXPECT_EQ(beside, 0u) << "of " << places;
  std::printf("worst %g, %zu of %zu places beside, %zu lines, %.0f cut\n", check.worst, beside, places, milled->report.lines,
              milled->report.cutting_length);
}

TEST(RestPasses, AreNoneOnAPlane) {
  auto plane = Terrain::from_grid({2, 2, {0, 0}, 10, 10, Terrain::Split::rising}, {0, 1, 2, 3});
  ASSERT_TRUE(plane);
  RestOptions o;
  o.tool.radius = 1, o.after = 2, o.scallop = 0.1;
  const auto milled = mill_rest(std::make_shared<const Terrain>(std::move(*plane)), o);
  ASSERT_FALSE(milled);
  EXPECT_NE(milled.error().text().find("no more than the threshold"), std::string::npos) << milled.error().text();
}

}  // namespace
}  // namespace krepl::test
