// Parallel passes of flat, bull-nose, conical and tapered cutters by brute force: never in the part, never farther from
// it than the tolerance.
#include <gtest/gtest.h>

#include <array>
#include <iostream>
#include <map>
#include <random>

#include "mill/cutter_check.hpp"
#include "mill/threads_check.hpp"
#include "support/environment.hpp"
#include "support/small_terrain.hpp"

namespace krepl::test {
namespace {

ParallelOptions options_for(const Cutter& cutter) {
  ParallelOptions o;
  o.tool.cutter = cutter;
  o.accuracy.unit = std::pow(10.0, std::floor(std::log10(cutter.radius() * 1e-3)) - 1);
  o.accuracy.tolerance = 40 * o.accuracy.unit;
  o.step_over = cutter.radius() / 3;
  o.zigzag = false;
  return o;
}

void expect_safe(const SmallTerrain& c, const ParallelOptions& o, const std::string& what) {
  const auto made = terrain_of(c);
  if (!made) return;
  const std::shared_ptr<const Terrain> part = *made;
  const auto milled = mill_parallel(part, o);
  ASSERT_TRUE(milled) << what << ": " << milled.error().text() << "\n" << c;
  const Cutter& cutter = *o.tool.cutter;
  const double scale = std::max(part->extent(), cutter.radius());
  const double floor = o.bottom ? *o.bottom - part->origin().z : part->lowest().z + o.tool.allowance;
  const TipHeights heights(part, cutter, o.tool.allowance, floor);
  const double feed = o.motion.feed, step = std::max(cutter.radius() / 4, scale / 60);
  const TipCheck check = check_tip(*part, heights, milled->path, o.accuracy.tolerance + o.accuracy.arc_error, step, 10,
                                   [feed](const Move& m) { return m.kind != MoveKind::rapid && m.feed == feed; });
  EXPECT_GT(check.places, 20u) << what;
  EXPECT_LE(check.deepest, 1e-9 * scale) << what << " gouges at " << check.deepest_at.x << " " << check.deepest_at.y
                                         << " " << check.deepest_at.z << ", angle " << o.angle << "\n"
                                         << c;
  EXPECT_EQ(check.far, 0u) << what << " is too far above at " << check.far_at.x << " " << check.far_at.y << " "
                           << check.far_at.z << ", angle " << o.angle << "\n"
                           << c;
  const double unit = o.accuracy.unit;
  double worst = 0;
  for (const Move& m : milled->path.moves)
    for (const double x : {m.end.x, m.end.y, m.end.z})
      worst = std::max(worst, std::abs(x / unit - std::round(x / unit)));
  EXPECT_LE(worst, 1e-4) << what;
}

TEST(Cutters, NeverCutIntoRandomTerrains) {
  std::mt19937 random(seed());
  const int cases = int(48 * effort());
  for (int k = 0; k < cases; ++k) {
    std::vector<std::uint8_t> bytes(8 + random() % 60);
    for (auto& b : bytes) b = std::uint8_t(random());
    const auto family = SmallTerrainFamily(unsigned(k) % unsigned(SmallTerrainFamily::count));
    const SmallTerrain c = decode_small_terrain(family, bytes);
    ParallelOptions o = options_for(any_cutter(random, c.radius));
    o.angle = std::array{0.0, 90.0, 30.0, -77.3, 180.0, 45.0}[random() % 6];
    if (random() % 4 == 0) o.tool.allowance = c.radius / 5;
    if (random() % 4 == 0) o.accuracy.arc_error = 10 * o.accuracy.unit;
    o.accuracy.tolerance += 2 * o.accuracy.arc_error;
    expect_safe(c, o, std::string(name(family)) + ", case " + std::to_string(k) + ", " + o.tool.cutter->text());
    if (HasFailure()) return;
  }
}

WaterlineOptions waterlines_for(const Cutter& cutter, double step_down) {
  WaterlineOptions o;
  o.tool.cutter = cutter;
  o.accuracy = options_for(cutter).accuracy;
  o.step_down = step_down;
  return o;
}

/// Cuts never come into the part, and nowhere farther from it than the tolerance; the share of moves that are lifted.
void expect_beside(const std::shared_ptr<const Terrain>& part, const WaterlineOptions& o, const MilledPath& milled,
                   double step, const std::string& what) {
  const double scale = std::max(part->extent(), o.tool.cutter->radius());
  const TipHeights heights(part, *o.tool.cutter, o.tool.allowance, -1e300);
  const TipCheck check = check_tip(*part, heights, milled.path, o.accuracy.tolerance, step, 10,
                                   [&](const Move& m) { return m.kind != MoveKind::rapid && m.feed == o.motion.feed; });
  EXPECT_GT(check.places, 20u) << what;
  EXPECT_LE(check.deepest, 1e-9 * scale) << what << " gouges at " << check.deepest_at.x << " " << check.deepest_at.y
                                         << " " << check.deepest_at.z;
  EXPECT_EQ(check.far, 0u) << what << " is too far at " << check.far_at.x << " " << check.far_at.y << " "
                           << check.far_at.z;
  EXPECT_LE(50 * milled.report.lifted_moves, milled.report.lines + milled.report.arcs) << what;
}

/// Where lines across the part pass from free places to others at a level, by steps of the drop cutter and halving:
/// near the path.
std::size_t expect_all_around(const std::shared_ptr<const Terrain>& part, const WaterlineOptions& o,
                              const MilledPath& milled, const std::string& what) {
  const TipHeights heights(part, *o.tool.cutter, o.tool.allowance, -1e300);
  const Point3 origin = part->origin(), low = part->lowest(), high = part->highest();
  const double radius = o.tool.cutter->radius(), step = radius / 8;
  std::map<double, std::vector<Point>> places;
  walk(milled.path, o.accuracy.tolerance * 2, 1, [&](Point3 p, const Move& m) {
    if (m.kind != MoveKind::rapid && m.feed == o.motion.feed) places[p.z].push_back({p.x - origin.x, p.y - origin.y});
  });
  std::size_t found = 0;
  for (const auto& [level, on_level] : places) {
    const double z = level - origin.z;
    for (const double s : {0.23, 0.61}) {
      const double y = low.y - radius + s * (high.y - low.y + 2 * radius);
      const auto is_free = [&](double x) { return heights.at({x, y}) <= z; };
      for (double x = low.x - 1.5 * radius; x < high.x + 1.5 * radius; x += step) {
        if (is_free(x) == is_free(x + step)) continue;
        double a = x, b = x + step;
        for (int k = 0; k < 40; ++k) (is_free(a + (b - a) / 2) == is_free(a) ? a : b) = a + (b - a) / 2;
        double nearest = 1e300;
        for (const Point p : on_level) nearest = std::min(nearest, std::hypot(p.x - a, p.y - y));
        // A wall is one tolerance off; the same in height is farther off on gentle ground: those places are left out.
        const double before = heights.at({a - o.accuracy.tolerance, y}),
                     after = heights.at({a + o.accuracy.tolerance, y});
        if (std::abs(before - after) < 4 * o.accuracy.tolerance) continue;
        ++found;
        EXPECT_LE(nearest, 6 * o.accuracy.tolerance) << what << " at " << a << " " << y << ", level " << level;
      }
    }
  }
  return found;
}

TEST(Cutters, WaterlinesAreBesideRandomTerrains) {
  std::mt19937 random(seed() + 1);
  std::size_t paths = 0, crossings = 0;
  for (int k = 0; k < 24 * effort(); ++k) {
    std::vector<std::uint8_t> bytes(40);
    for (auto& b : bytes) b = std::uint8_t(random());
    SmallTerrain c = decode_small_terrain(SmallTerrainFamily(k % 6), bytes);
    c.radius = k % 5 == 0 ? 0.4 : 1.3;
    const auto part = terrain_of(c);
    if (!part) continue;
    const double height = (*part)->highest().z - (*part)->lowest().z;
    WaterlineOptions o = waterlines_for(any_cutter(random, c.radius), std::max(height, 0.1) / 3.5);
    if (random() % 4 == 0) o.tool.allowance = c.radius / 5;
    const auto milled = mill_waterline(*part, o);
    if (!milled) continue;  // flat
    ++paths;
    const std::string what = "case " + std::to_string(k) + ", " + o.tool.cutter->text();
    expect_beside(*part, o, *milled, 0.1 * std::max(1.0, height / 4), what);
    if (k % 3 == 0) crossings += expect_all_around(*part, o, *milled, what);
    if (HasFailure()) {
      std::cout << c << "\n";
      return;
    }
  }
  EXPECT_GT(double(paths), 12 * effort());
  EXPECT_GT(double(crossings), 40 * effort());
}

/// A block with a wall on all sides: around it a flat cutter runs at its radius, along lines and quarters of circles.
TEST(Cutters, WaterlinesOfAFlatCutterAreAtItsRadiusFromWalls) {
  std::vector<Point3> corners;
  std::vector<std::array<Terrain::Index, 3>> triangles;
  const auto quad = [&](Point3 a, Point3 b, Point3 c, Point3 d) {
    const auto n = Terrain::Index(corners.size());
    corners.insert(corners.end(), {a, b, c, d});
    triangles.push_back({n, n + 1, n + 2}), triangles.push_back({n, n + 2, n + 3});
  };
  quad({0, 0, 0}, {20, 0, 0}, {20, 20, 0}, {0, 20, 0});
  quad({8, 8, 3}, {12, 8, 3}, {12, 12, 3}, {8, 12, 3});
  quad({8, 8, 0}, {12, 8, 0}, {12, 8, 3}, {8, 8, 3});
  quad({12, 8, 0}, {12, 12, 0}, {12, 12, 3}, {12, 8, 3});
  quad({12, 12, 0}, {8, 12, 0}, {8, 12, 3}, {12, 12, 3});
  quad({8, 12, 0}, {8, 8, 0}, {8, 8, 3}, {8, 12, 3});
  const auto part = Terrain::from_triangles(corners, triangles);
  ASSERT_TRUE(part) << part.error().text();
  WaterlineOptions o;
  o.tool.cutter = *Cutter::flat(3);
  o.step_down = 1;
  const auto milled = mill_waterline(std::make_shared<const Terrain>(*part), o);
  ASSERT_TRUE(milled) << milled.error().text();
  EXPECT_EQ(milled->report.cuts, 3u);
  EXPECT_EQ(milled->report.lifted_moves, 0u);
  EXPECT_LE(milled->report.lines + milled->report.arcs, 80u);
  walk(milled->path, 0.1, 4, [&](Point3 p, const Move& m) {
    if (m.kind == MoveKind::rapid || m.feed != o.motion.feed) return;
    const double dx = std::max({8 - p.x, p.x - 12, 0.0}), dy = std::max({8 - p.y, p.y - 12, 0.0}),
                 off = std::hypot(dx, dy);
    EXPECT_GE(off, 1.5 - 1e-9);
    EXPECT_LE(off, 1.5 + o.accuracy.tolerance);
  });
}

TEST(Cutters, AreTheSameForAnyNumberOfThreads) {
  std::vector<double> heights;
  std::mt19937 random(7);
  for (int k = 0; k < 64; ++k) heights.push_back(double(random() % 5));
  const auto made = Terrain::from_grid({8, 8, {0, 0}, 1, 1, Terrain::Split::rising}, heights);
  ASSERT_TRUE(made);
  const auto part = std::make_shared<const Terrain>(*made);
  const Cutter bull = *Cutter::bull_nose(2, 0.3);
  expect_same_from_any_threads(
      [&](const Context& context) { return mill_waterline(part, waterlines_for(bull, 0.8), context); });
  expect_same_from_any_threads([&](const Context& context) { return mill_parallel(part, options_for(bull), context); });
}

TEST(Cutters, ThatAStrategyCannotTakeAreErrors) {
  const auto made = Terrain::from_grid({2, 2, {0, 0}, 1, 1, Terrain::Split::rising}, {0, 1, 2, 0});
  ASSERT_TRUE(made);
  const auto part = std::make_shared<const Terrain>(*made);
  const Cutter flat = *Cutter::flat(1);
  ScallopOptions constant;
  constant.tool.cutter = flat, constant.scallop = 0.1;
  PencilOptions pencil;
  pencil.tool.cutter = flat;
  ParallelOptions scallop = options_for(flat);
  scallop.step_over = 0, scallop.scallop = 0.1;
  ParallelOptions centre = options_for(flat);
  centre.accuracy.control_point = ControlPoint::centre;
  for (const auto& milled : {mill_scallop(part, constant), mill_pencil(part, pencil), mill_parallel(part, scallop),
                             mill_parallel(part, centre)}) {
    ASSERT_FALSE(milled);
    EXPECT_EQ(milled.error().code, ErrorCode::usage);
    EXPECT_NE(milled.error().text().find("flat:1"), std::string::npos) << milled.error().text();
  }
}

}  // namespace
}  // namespace krepl::test
