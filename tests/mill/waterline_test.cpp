// Waterlines and pencil passes by brute force: never in the part and its allowance, nowhere farther from it than the
// tolerance, and all around it: places of the level set from another construction are near the path.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "mill/path_check.hpp"
#include "mill/threads_check.hpp"
#include "support/environment.hpp"
#include "support/small_terrain.hpp"

namespace krepl::test {
namespace {

bool is_arc(const Move& m) { return m.kind == MoveKind::clockwise || m.kind == MoveKind::counter_clockwise; }

/// Moves at the feed: links have the plunge feed.
std::vector<std::pair<Point3, Move>> level_moves(const ToolPath& path, double feed) {
  std::vector<std::pair<Point3, Move>> found;
  Point3 at = path.start;
  for (const Move& m : path.moves) {
    if (m.kind != MoveKind::rapid && m.feed == feed) found.push_back({at, m});
    at = m.end;
  }
  return found;
}

double distance(Point p, Point3 a, Point3 b) {
  const double ux = b.x - a.x, uy = b.y - a.y, squared = ux * ux + uy * uy;
  const double s = squared > 0 ? std::clamp(((p.x - a.x) * ux + (p.y - a.y) * uy) / squared, 0.0, 1.0) : 0;
  return std::hypot(a.x + s * ux - p.x, a.y + s * uy - p.y);
}

/// Cuts never come nearer than the radius, and nowhere farther than `outer`; `step` is the sampling.
template <class Options>
void expect_beside(const std::shared_ptr<const Terrain>& part, const Options& o, const MilledPath& milled, double step,
                   const std::string& name) {
  const double grown = o.tool.radius + o.tool.allowance, outer = grown + o.accuracy.tolerance;
  const double extent = std::max(part->extent(), grown);
  // Links, and moves over what is in the way, have the plunge feed.
  const auto is_cut = [&](const Move& m) { return m.kind != MoveKind::rapid && m.feed == o.motion.feed; };
  const PathCheck check = check_path(*part, part, milled.path, grown, outer, -1e300, step, 10, is_cut);
  EXPECT_GT(check.places, 20u) << name;
  EXPECT_LE(check.deepest, 1e-9 * extent)
      << name << " at " << check.deepest_at.x << " " << check.deepest_at.y << " " << check.deepest_at.z;
  EXPECT_LE(check.highest, 1e-9 * extent)
      << name << " at " << check.highest_at.x << " " << check.highest_at.y << " " << check.highest_at.z;
  // Next to nearly vertical valleys a few moves are not proven.
  if constexpr (std::is_same_v<Options, PencilOptions>)
    EXPECT_LE(20 * milled.report.lifted_moves, std::max<std::size_t>(milled.report.lines, 60)) << name;
  else
    EXPECT_EQ(milled.report.lifted_moves, 0u) << name;
}

/// Places where a line across the part passes the level set of a ball's surface, found by halving, are within `near` of
/// the path on that level.
void expect_complete(const Terrain& part, const std::shared_ptr<const Terrain>& shared, const MilledPath& milled,
                     double feed, double radius, double near, const std::string& name) {
  const auto cutter = DropCutter::build(shared, radius);
  const Point3 origin = part.origin();
  std::map<double, std::vector<std::pair<Point3, Point3>>> chords;
  for (const auto& [from, m] : level_moves(milled.path, feed)) {
    ToolPath one;
    one.start = from, one.moves = {m};
    Point3 before = from;
    auto& level = chords[m.end.z];
    walk(one, is_arc(m) ? 0.02 * radius : 1e300, 1, [&](Point3 p, const Move&) {
      level.push_back({before, p});
      before = p;
    });
  }
  ASSERT_FALSE(chords.empty()) << name;
  std::size_t crossings = 0, missed = 0;
  Point3 worst{};
  int number = 0;
  for (const auto& [z, pieces] : chords) {
    if (++number % 3 != 0 && chords.size() > 6) continue;
    const double level = z - origin.z, margin = 1.1 * radius;
    const Point3 low = part.lowest(), high = part.highest();
    for (int line = 0; line < 17; ++line) {
      const double s = (line + 0.37) / 17;
      const bool along_x = line % 2 == 0;
      const auto place = [&](double t) {
        const double x0 = low.x - margin, x1 = high.x + margin, y0 = low.y - margin, y1 = high.y + margin;
        return along_x ? Point{x0 + t * (x1 - x0), y0 + s * (y1 - y0)} : Point{x0 + s * (x1 - x0), y0 + t * (y1 - y0)};
      };
      const int n = 150;
      const auto is_high = [&](double t) { return cutter->at(place(t)).height > level; };
      bool before = is_high(0);
      for (int k = 1; k <= n; ++k) {
        double a = double(k - 1) / n, b = double(k) / n;
        const bool now = is_high(b);
        if (now != before) {
          for (int halving = 0; halving < 45; ++halving) (is_high((a + b) / 2) == before ? a : b) = (a + b) / 2;
          const Point p = place(a);
          const Point absolute{p.x + origin.x, p.y + origin.y};
          double best = 1e300;
          for (const auto& [from, to] : pieces) best = std::min(best, distance(absolute, from, to));
          ++crossings;
          if (best > near) ++missed, worst = {p.x, p.y, level};
        }
        before = now;
      }
    }
  }
  EXPECT_GT(crossings, 3u) << name;
  EXPECT_EQ(missed, 0u) << name << ": of " << crossings << ", at " << worst.x << " " << worst.y << " " << worst.z;
}

/// A block with a pocket, a boss and a dome: walls, level ground, slopes.
std::shared_ptr<const Terrain> made_block() {
  const std::size_t n = 41;
  std::vector<double> heights;
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i) {
      const double x = double(i) / 2, y = double(j) / 2;
      double z = 0;
      const double dome = 16 - (x - 6) * (x - 6) - (y - 13) * (y - 13);
      if (dome > 0) z = std::sqrt(dome);
      if (x >= 11 && x <= 18 && y >= 3 && y <= 17) z = 5;
      if (x >= 13 && x <= 16 && y >= 8 && y <= 14) z = 2;
      if (std::hypot(x - 5, y - 5) < 3) z = std::max(z, 4 * (1 - std::hypot(x - 5, y - 5) / 3));
      heights.push_back(z);
    }
  auto made = Terrain::from_grid({n, n, {100, -50}, 0.5, 0.5, Terrain::Split::rising}, heights);
  return std::make_shared<const Terrain>(std::move(*made));
}

WaterlineOptions options(double radius, double step_down) {
  WaterlineOptions o;
  o.tool.radius = radius, o.step_down = step_down;
  return o;
}

TEST(Waterline, RunsAroundTheBlockWithinTheTolerance) {
  const auto part = made_block();
  for (int k = 0; k < 4; ++k) {
    WaterlineOptions o = options(k % 2 == 0 ? 1 : 1.5, 0.6);
    o.tool.allowance = 0.15 * (k % 3), o.climb = k % 2 == 0;
    o.accuracy.control_point = k < 2 ? ControlPoint::tip : ControlPoint::centre;
    if (k == 2) o.accuracy.tolerance = 0.05, o.accuracy.unit = 1e-3;
    if (k == 3) o.bottom = -2, o.accuracy.arcs = false;
    const std::string name = "case " + std::to_string(k);
    const auto milled = mill_waterline(part, o);
    ASSERT_TRUE(milled) << milled.error().text();
    EXPECT_EQ(milled->report.arcs > 20, o.accuracy.arcs) << name;
    const double spacing = std::sqrt(8 * o.accuracy.tolerance * o.tool.radius);
    expect_beside(part, o, *milled, spacing / 10, name);
    // On slopes of at least 1 in 5 a distance from the part is five times that in the plane; level ground is where
    // places are not told.
    const double grown = o.tool.radius + o.tool.allowance;
    expect_complete(*part, part, *milled, o.motion.feed, grown + o.accuracy.tolerance / 2, 5.1 * o.accuracy.tolerance,
                    name);
  }
}

TEST(Waterline, HasArcsAroundCorners) {
  // A square post: around each vertical edge of it a quarter of a circle, between them a line, on each level.
  std::vector<double> heights(25, 0.0);
  heights[12] = 4;
  const auto made = Terrain::from_grid({5, 5, {0, 0}, 2, 2, Terrain::Split::rising}, heights);
  ASSERT_TRUE(made);
  const auto part = std::make_shared<const Terrain>(*made);
  WaterlineOptions o = options(0.5, 0.5);
  const auto milled = mill_waterline(part, o);
  ASSERT_TRUE(milled) << milled.error().text();
  expect_beside(part, o, *milled, 0.01, "post");
  EXPECT_LE(milled->report.lines + milled->report.arcs, 40 * milled->report.levels);
  EXPECT_GE(milled->report.arcs, milled->report.levels);
}

TEST(Waterline, TurnsTheWayAskedFor) {
  const auto part = made_block();
  for (const bool climb : {true, false}) {
    WaterlineOptions o = options(1, 1);
    o.climb = climb;
    const auto milled = mill_waterline(part, o);
    ASSERT_TRUE(milled);
    const auto cutter = DropCutter::build(part, 1);
    const Point3 origin = part->origin();
    std::size_t right = 0, left = 0;
    for (const auto& [from, m] : level_moves(milled->path, o.motion.feed)) {
      const double dx = m.end.x - from.x, dy = m.end.y - from.y, far = std::hypot(dx, dy);
      if (is_arc(m) || far < 0.5) continue;
      const Point middle{(from.x + m.end.x) / 2 - origin.x, (from.y + m.end.y) / 2 - origin.y};
      const auto height = [&](double aside) { return cutter->at({middle.x - aside * dy / far, middle.y + aside * dx / far}).height; };
      if (height(0.05) == height(-0.05)) continue;
      ++(height(0.05) > height(-0.05) ? left : right);
    }
    EXPECT_GT(left + right, 20u);
    EXPECT_EQ(climb ? left : right, 0u);
  }
}

TEST(Waterline, LeavesGentleSlopesOut) {
  const auto part = made_block();
  WaterlineOptions o = options(1, 0.5);
  const auto all = mill_waterline(part, o);
  o.steep = 60;
  const auto steep = mill_waterline(part, o);
  ASSERT_TRUE(all && steep);
  EXPECT_LT(steep->report.cutting_length, 0.9 * all->report.cutting_length);
  expect_beside(part, o, *steep, 0.03, "steep");
  // On the right of the way the surface rises.
  const auto cutter = DropCutter::build(part, 1);
  const Point3 origin = part->origin();
  std::size_t looked_at = 0, gentle = 0, gentle_of_all = 0;
  for (const auto* path : {&steep->path, &all->path})
    for (const auto& [from, m] : level_moves(*path, o.motion.feed)) {
      const double dx = m.end.x - from.x, dy = m.end.y - from.y, far = std::hypot(dx, dy);
      if (is_arc(m) || far == 0) continue;
      const Point beside{(from.x + m.end.x) / 2 - origin.x + 0.1 * dy / far,
                         (from.y + m.end.y) / 2 - origin.y - 0.1 * dx / far};
      const bool rises = cutter->at(beside).height > m.end.z - origin.z + 0.1;  // 45 degrees
      if (path == &all->path)
        gentle_of_all += !rises;
      else
        ++looked_at, gentle += !rises;
    }
  EXPECT_GT(looked_at, 50u);
  EXPECT_LE(double(gentle), 0.02 * double(looked_at));
  EXPECT_GT(gentle_of_all, 50u);
}

TEST(Pencil, RunsAlongTheBottomOfAGroove) {
  // z = 2 |x - 2|, rising by 1/4 along y: the ball touches both sides, its centre R sqrt(1 + 4 + ...) above the bottom.
  std::vector<double> heights;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 5; ++i) heights.push_back(2.0 * std::abs(i - 2) + 0.25 * j);
  const auto made = Terrain::from_grid({5, 4, {0, 0}, 1, 1, Terrain::Split::rising}, heights);
  ASSERT_TRUE(made);
  PencilOptions o;
  o.tool.radius = 0.5, o.tool.allowance = 0.1;
  const auto milled = mill_pencil(std::make_shared<const Terrain>(*made), o);
  ASSERT_TRUE(milled) << milled.error().text();
  EXPECT_EQ(milled->report.cuts, 1u);
  EXPECT_EQ(milled->report.lifted_moves, 0u);
  // Planes z = 2 x + y / 4 and its mirror image: the normal has the length sqrt(1 + 4 + 1/16).
  const double above = 0.6 * std::sqrt(5 + 1 / 16.0), slack = 1.0001 * o.accuracy.tolerance * std::sqrt(5.1);
  double length = 0;
  for (const auto& [from, m] : level_moves(milled->path, o.motion.feed)) {
    EXPECT_NEAR(m.end.x, 2, o.accuracy.tolerance);
    if (m.end.y < 0.2 || m.end.y > 2.8) continue;  // the ends of the groove
    EXPECT_GE(m.end.z, 0.25 * m.end.y + above - 1e-9);
    EXPECT_LE(m.end.z, 0.25 * m.end.y + above + slack);
  }
  for (const auto& [from, m] : level_moves(milled->path, o.motion.feed))
    length += std::hypot(m.end.y - from.y, m.end.z - from.z);
  EXPECT_GT(length, 2.8);
}

TEST(Pencil, RunsAlongCornersOnly) {
  const auto part = made_block();
  PencilOptions o;
  o.tool.radius = 0.6;
  const auto milled = mill_pencil(part, o);
  ASSERT_TRUE(milled) << milled.error().text();
  EXPECT_GT(milled->report.cutting_length, 40);  // the pocket's floor, the block's foot
  // Both to the left and to the right of the way the surface rises more than it would along a line.
  const auto cutter = DropCutter::build(part, o.tool.radius);
  const Point3 origin = part->origin();
  std::size_t looked_at = 0, flat = 0;
  for (const auto& [from, m] : level_moves(milled->path, o.motion.feed)) {
    const double dx = m.end.x - from.x, dy = m.end.y - from.y, far = std::hypot(dx, dy), aside = 0.05;
    if (far < 0.02) continue;
    const Point p{(from.x + m.end.x) / 2 - origin.x, (from.y + m.end.y) / 2 - origin.y};
    const double left = cutter->at({p.x - aside * dy / far, p.y + aside * dx / far}).height,
                 right = cutter->at({p.x + aside * dy / far, p.y - aside * dx / far}).height,
                 here = (from.z + m.end.z) / 2 - origin.z;
    ++looked_at;
    // 20 degrees between the sides, less what the path is above them and the ball's own curvature.
    flat += left + right - 2 * here < aside * std::tan(20 * 3.14159265 / 180) - 3 * o.accuracy.tolerance;
  }
  EXPECT_GT(looked_at, 30u);
  EXPECT_LE(double(flat), 0.02 * double(looked_at));
}

TEST(Pencil, ChecksItsOptions) {
  const auto part = made_block();
  PencilOptions o;
  EXPECT_EQ(mill_pencil(part, o).error().code, ErrorCode::usage);
  o.tool.radius = 1, o.valley_angle = 180;
  EXPECT_EQ(mill_pencil(part, o).error().code, ErrorCode::usage);
  const auto flat = Terrain::from_grid({3, 3, {0, 0}, 1, 1, Terrain::Split::rising}, std::vector<double>(9, 2.0));
  o.valley_angle = 20;
  EXPECT_EQ(mill_pencil(std::make_shared<const Terrain>(*flat), o).error().code, ErrorCode::input);
}

TEST(Waterline, IsTheSameForAnyNumberOfThreads) {
  const auto part = made_block();
  PencilOptions pencil;
  pencil.tool.radius = 0.6;
  expect_same_from_any_threads([&](const Context& context) { return mill_waterline(part, options(1, 0.7), context); });
  expect_same_from_any_threads([&](const Context& context) { return mill_pencil(part, pencil, context); });
}

TEST(Waterline, IsBesideRandomTerrains) {
  std::mt19937 random(seed());
  std::size_t paths = 0, pencils = 0;
  for (int k = 0; k < 24 * effort(); ++k) {
    std::vector<std::uint8_t> bytes(48);
    for (auto& b : bytes) b = std::uint8_t(random());
    SmallTerrain c = decode_small_terrain(SmallTerrainFamily(k % 6), bytes);
    c.radius = k % 5 == 0 ? 0.4 : 1.3;
    const auto part = terrain_of(c);
    if (!part) continue;
    const double height = (*part)->highest().z - (*part)->lowest().z + c.radius;
    WaterlineOptions o = options(c.radius, height / 6.5);
    if (k % 3 == 0) o.bottom = (*part)->lowest().z + (*part)->origin().z - 1;
    const auto milled = mill_waterline(*part, o);
    PencilOptions v;
    v.tool = o.tool;
    if (const auto valleys = mill_pencil(*part, v))
      expect_beside(*part, v, *valleys, 0.05 * std::max(1.0, height / 4), "valleys of case " + std::to_string(k)),
          ++pencils;
    if (!milled) continue;  // flat, or nothing above the lowest level
    ++paths;
    expect_beside(*part, o, *milled, 0.05 * std::max(1.0, height / 4), "case " + std::to_string(k));
  }
  EXPECT_GT(double(paths), 12 * effort());
  EXPECT_GT(double(pencils), 6 * effort());
}

TEST(Waterline, ChecksItsOptions) {
  const auto part = made_block();
  WaterlineOptions o = options(1, 0);
  EXPECT_EQ(mill_waterline(part, o).error().code, ErrorCode::usage);
  o.step_down = 1, o.steep = 90;
  EXPECT_EQ(mill_waterline(part, o).error().code, ErrorCode::usage);
  o.steep = 0, o.bottom = 20;
  EXPECT_EQ(mill_waterline(part, o).error().code, ErrorCode::usage);
  o.bottom.reset(), o.step_down = 1e-7;
  EXPECT_EQ(mill_waterline(part, o).error().code, ErrorCode::usage);
  o = options(1, 1), o.tool.radius = -1;
  EXPECT_EQ(mill_waterline(part, o).error().code, ErrorCode::usage);
  const auto flat = Terrain::from_grid({3, 3, {0, 0}, 1, 1, Terrain::Split::rising}, std::vector<double>(9, 2.0));
  ASSERT_TRUE(flat);
  EXPECT_FALSE(mill_waterline(std::make_shared<const Terrain>(*flat), options(1, 1)));
}

}  // namespace
}  // namespace krepl::test
