// Roughing by brute force: never in the part and its allowance, never rapidly through stock, and the stock is gone
// afterwards where the tool has room.
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <optional>
#include <random>

#include "krepl/simulation.hpp"
#include "mill/cutter_check.hpp"
#include "mill/threads_check.hpp"
#include "support/environment.hpp"
#include "support/small_terrain.hpp"

namespace krepl::test {
namespace {

/// Columns of stock over a raster.
class Stock {
 public:
  Stock(Point low, Point high, double top, double cell) : low_(low), cell_(cell) {
    columns_ = std::size_t((high.x - low.x) / cell) + 1, rows_ = std::size_t((high.y - low.y) / cell) + 1;
    top_.assign(columns_ * rows_, top);
  }
  /// Takes off what a ball covers; returns how deep it went in.
  double cut(Point3 c, double radius) {
    double deepest = 0;
    const auto range = [&](double x, double from, std::size_t count) {
      const double first = std::max(0.0, std::ceil((x - radius - from) / cell_)),
                   last = std::floor((x + radius - from) / cell_);
      return std::pair(std::size_t(first), last < 0 ? std::size_t(0) : std::min(count, std::size_t(last) + 1));
    };
    const auto [i0, i1] = range(c.x, low_.x, columns_);
    const auto [j0, j1] = range(c.y, low_.y, rows_);
    for (std::size_t j = j0; j < j1; ++j)
      for (std::size_t i = i0; i < i1; ++i) {
        const double dx = place(i, j).x - c.x, dy = place(i, j).y - c.y, under = radius * radius - dx * dx - dy * dy;
        if (under <= 0) continue;
        double& top = top_[j * columns_ + i];
        const double bottom = c.z - std::sqrt(under);
        deepest = std::max(deepest, top - bottom);
        top = std::min(top, bottom);
      }
    return deepest;
  }
  /// The same for the disk of a flat cutter; returns the area that was lowered.
  double cut_flat(Point3 tip, double radius) {
    std::size_t lowered = 0;
    for (std::size_t j = 0; j < rows_; ++j) {
      const double dy = place(0, j).y - tip.y, under = radius * radius - dy * dy;
      if (under <= 0) continue;
      const double half = std::sqrt(under);
      for (auto i = std::size_t(std::max(0.0, std::ceil((tip.x - half - low_.x) / cell_)));
           i < columns_ && place(i, j).x <= tip.x + half; ++i)
        if (double& top = top_[j * columns_ + i]; top > tip.z + 1e-9) top = tip.z, ++lowered;
    }
    return double(lowered) * cell_ * cell_;
  }
  Point place(std::size_t i, std::size_t j) const { return {low_.x + double(i) * cell_, low_.y + double(j) * cell_}; }
  std::size_t columns() const { return columns_; }
  std::size_t rows() const { return rows_; }
  double top(std::size_t i, std::size_t j) const { return top_[j * columns_ + i]; }

 private:
  Point low_;
  double cell_;
  std::size_t columns_, rows_;
  std::vector<double> top_;
};

std::shared_ptr<const Terrain> bumps(std::uint64_t seed_of_case) {
  std::mt19937_64 random(seed_of_case);
  const std::size_t n = 21;
  std::vector<double> heights;
  for (std::size_t k = 0; k < n * n; ++k) heights.push_back(0);
  for (int b = 0; b < 4; ++b) {
    const double x = double(random() % 20), y = double(random() % 20), r = 2 + double(random() % 5),
                 h = 1 + double(random() % 5);
    const bool box = random() % 2 == 0;
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i) {
        const double d = std::hypot(double(i) - x, double(j) - y);
        double& z = heights[j * n + i];
        if (d < r) z = std::max(z, box ? h : h * (1 - d / r));
      }
  }
  auto made = Terrain::from_grid({n, n, {0, 0}, 1, 1, Terrain::Split::rising}, heights);
  return std::make_shared<const Terrain>(std::move(*made));
}

TEST(Roughing, TakesTheStockOffAndLeavesTheAllowance) {
  for (int k = 0; k < 12; ++k) {
    const auto part = bumps(seed() + std::uint64_t(k % 6));
    RoughOptions o;
    o.tool.radius = 1.5, o.tool.allowance = 0.2 * (k % 3), o.step_over = 1, o.step_down = 1.1, o.angle = 45 * (k % 4);
    o.stock_margin = k % 2, o.ramp_angle = 5;
    o.pattern = k < 6 ? RoughPattern::zigzag : RoughPattern::offsets;
    if (k % 6 >= 4) o.stock_top = part->highest().z + part->origin().z + 1.3;
    o.accuracy.control_point = k % 2 == 0 ? ControlPoint::tip : ControlPoint::centre;
    const auto milled = mill_rough(part, o);
    ASSERT_TRUE(milled) << milled.error().text();
    const double grown = o.tool.radius + o.tool.allowance;
    const PathCheck check = check_path(*part, part, milled->path, grown, grown + 1, part->lowest().z + grown, 0.3, 10,
                                       [](const Move&) { return false; });
    EXPECT_LE(check.deepest, 1e-9 * part->extent()) << "case " << k;

    const Point3 origin = part->origin(), low = part->lowest(), high = part->highest();
    const double margin = o.stock_margin, top = o.stock_top ? *o.stock_top : high.z + origin.z;
    Stock stock({low.x + origin.x - margin, low.y + origin.y - margin},
                {high.x + origin.x + margin, high.y + origin.y + margin}, top, 0.23);
    double rapid_depth = 0, steepest = 0;
    Point3 steepest_at{};
    Point3 before = milled->path.start;
    walk(milled->path, 0.15, 1, [&](Point3 p, const Move& m) {
      const double depth = stock.cut(p, o.tool.radius);
      if (m.kind == MoveKind::rapid) rapid_depth = std::max(rapid_depth, depth);
      // Into stock it goes down by ramps only.
      const double along = std::hypot(p.x - before.x, p.y - before.y), down = before.z - p.z;
      if (const double slope = std::atan2(down, along); down > 1e-9 && depth > 0.1 && slope > steepest)
        steepest = slope, steepest_at = p;
      before = p;
    });
    EXPECT_LE(rapid_depth, 1e-9) << "case " << k << ": a rapid move cuts";
    EXPECT_LE(steepest, 5.01 * std::numbers::pi / 180)
        << "case " << k << " at " << steepest_at.x << " " << steepest_at.y << " " << steepest_at.z;

    // What is left where the tool fits on a level: above the ball's closing of the part no more than a level and a
    // ridge.
    const auto cutter = DropCutter::build(part, grown);
    const double ridge = o.tool.radius - std::sqrt(o.tool.radius * o.tool.radius - o.step_over * o.step_over / 4);
    std::size_t open = 0, left = 0;
    for (std::size_t j = 0; j < stock.rows(); ++j)
      for (std::size_t i = 0; i < stock.columns(); ++i) {
        const Point p = stock.place(i, j);
        // The ball's centre over a circle about the place: where it is free to move at the least height, all around.
        double level = -1e300;
        for (int a = 0; a < 12; ++a)
          for (const double r : {0.0, 1.1}) {
            const double angle = a * std::numbers::pi / 6;
            const auto h =
                cutter->at({p.x + r * std::cos(angle) - origin.x, p.y + r * std::sin(angle) - origin.y}).height;
            level = std::max({level, h, low.z + grown});
          }
        ++open;
        left += stock.top(i, j) > level + origin.z - o.tool.radius + o.step_down + ridge + 0.02;
      }
    EXPECT_LE(double(left), 0.01 * double(open))
        << "case " << k << ": " << left << " of " << open << ", skipped " << milled->report.skipped_cuts;
    EXPECT_GT(milled->report.levels, 2u);
  }
}

/// A block of 20 x 20 with a pocket of `side`, 3 deep, in its middle.
std::shared_ptr<const Terrain> pocket(double side) {
  const std::size_t n = 81;
  std::vector<double> heights;
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i)
      heights.push_back(std::max(std::abs(double(i) / 4 - 10), std::abs(double(j) / 4 - 10)) < side / 2 ? 0 : 3);
  auto made = Terrain::from_grid({n, n, {0, 0}, 0.25, 0.25, Terrain::Split::rising}, heights);
  return std::make_shared<const Terrain>(std::move(*made));
}

TEST(Roughing, EntersPocketsDownHelicesElseDownRamps) {
  for (const double side : {8.0, 2.4}) {
    const auto part = pocket(side);
    RoughOptions o;
    o.tool.radius = 1, o.step_over = 0.7, o.step_down = 1, o.ramp_angle = 4;
    const auto milled = mill_rough(part, o);
    ASSERT_TRUE(milled) << milled.error().text();
    std::size_t helices = 0;
    Point3 at = milled->path.start;
    double steepest = 0;
    for (const Move& m : milled->path.moves) {
      if (m.kind == MoveKind::counter_clockwise && m.end.z < at.z) {
        ++helices;
        const double r0 = std::hypot(at.x - m.centre.x, at.y - m.centre.y),
                     r1 = std::hypot(m.end.x - m.centre.x, m.end.y - m.centre.y);
        EXPECT_NEAR(r0, r1, 1e-9);
        EXPECT_GE(r0, o.tool.radius / 4 - o.accuracy.unit);
        steepest = std::max(steepest, std::atan((at.z - m.end.z) / (std::numbers::pi * r0)));
      }
      at = m.end;
    }
    if (side > 5)
      EXPECT_GT(helices, 5u);
    else
      EXPECT_EQ(helices, 0u) << "there is no room";
    EXPECT_LE(steepest, 4.0001 * std::numbers::pi / 180);
    StockOptions block;
    block.cell = 0.08;
    const auto left = Simulation::run(milled->path, *part, *Cutter::ball(2), block);
    ASSERT_TRUE(left) << left.error().text();
    EXPECT_EQ(left->report().cutting_rapids, 0u) << "rapid moves cut " << left->report().rapid_cut.value << " deep";
    EXPECT_EQ(left->report().gouged_dexels, 0u);
    // What is left on the pocket's ground, where the ball gets to.
    double most = 0;
    Point most_at{};
    for (std::size_t r = 0; r < left->rows(); ++r)
      for (std::size_t c = 0; c < left->columns(); ++c) {
        const Point p = left->place(c, r);
        if (std::max(std::abs(p.x - 10), std::abs(p.y - 10)) < side / 2 - 1.3)
          if (const double z = left->left()[r * left->columns() + c]; z > most) most = z, most_at = p;
      }
    // In corners rings are half of 0.7 sqrt(2) from what is farthest.
    EXPECT_LT(most, 1 - std::sqrt(1 - 0.5 * 0.5) + 0.02) << side << " at " << most_at.x << " " << most_at.y;
  }
}

/// A boss in a block is cut around from outside: in no place much more than the step-over is cut at once.
TEST(Roughing, OffsetsCutStripsOfTheStepOver) {
  const std::size_t n = 81;
  std::vector<double> heights;
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i)
      heights.push_back(std::hypot(double(i) / 4 - 9, double(j) / 4 - 11) < 4 ? 3 : 0);
  auto made = Terrain::from_grid({n, n, {0, 0}, 0.25, 0.25, Terrain::Split::rising}, heights);
  const auto part = std::make_shared<const Terrain>(std::move(*made));
  std::map<RoughPattern, double> share;
  for (const RoughPattern pattern : {RoughPattern::offsets, RoughPattern::zigzag}) {
    RoughOptions o;
    o.tool.cutter = *Cutter::flat(2), o.step_over = 0.6, o.step_down = 1.5, o.pattern = pattern;
    const auto milled = mill_rough(part, o);
    ASSERT_TRUE(milled) << milled.error().text();
    // Area taken off by each tenth of the way; a tool that moves by d and cuts a strip of width w takes off d w.
    Stock stock({0, 0}, {20, 20}, 3, 0.05);
    const double step = 0.1;
    double all = 0, wide = 0;
    std::optional<Point3> before;
    walk(milled->path, step, 1, [&](Point3 p, const Move& m) {
      if (before && m.kind != MoveKind::rapid && p.z == before->z) {
        const double way = std::hypot(p.x - before->x, p.y - before->y), area = stock.cut_flat({p.x, p.y, p.z}, 1);
        all += area;
        if (area > 1.5 * o.step_over * way + 0.02) wide += area;
      } else {
        stock.cut_flat(p, 1);
      }
      before = p;
    });
    EXPECT_GT(all, 300.0);
    share[pattern] = wide / all;
    std::printf("pattern %d: %.1f %% of the area in strips wider than 1.5 step-overs\n", int(pattern),
                100 * wide / all);
  }
  EXPECT_LT(share[RoughPattern::offsets], 0.03);
  EXPECT_GT(share[RoughPattern::zigzag], 2 * share[RoughPattern::offsets]);
}

TEST(Roughing, OfOtherCuttersNeverCutsIntoRandomTerrains) {
  std::mt19937 random(seed());
  const int cases = int(24 * effort());
  int done = 0;
  for (int k = 0; k < cases; ++k) {
    std::vector<std::uint8_t> bytes(8 + random() % 60);
    for (auto& b : bytes) b = std::uint8_t(random());
    const auto family = SmallTerrainFamily(unsigned(k) % unsigned(SmallTerrainFamily::count));
    const SmallTerrain c = decode_small_terrain(family, bytes);
    const auto part = terrain_of(c);
    if (!part) continue;
    const double height = (*part)->highest().z - (*part)->lowest().z;
    RoughOptions o;
    const double radius = std::clamp(c.radius, (*part)->extent() / 10, (*part)->extent() / 2);
    o.tool.cutter = random() % 4 == 0 ? *Cutter::ball(2 * radius) : any_cutter(random, radius);
    o.tool.radius = radius;
    if (random() % 2 == 0) o.tool.allowance = radius / 8;
    o.pattern = random() % 3 == 0 ? RoughPattern::zigzag : RoughPattern::offsets;
    o.step_over = radius * std::array{0.5, 0.9, 1.5}[random() % 3], o.step_down = std::max(height / 4, radius / 4);
    o.accuracy.unit = std::pow(10.0, std::floor(std::log10(radius * 1e-3)) - 1),
    o.accuracy.tolerance = 40 * o.accuracy.unit;
    o.stock_top = (*part)->highest().z + (*part)->origin().z + radius / 3;
    const std::string what = std::string(name(family)) + ", case " + std::to_string(k) + ", " + o.tool.cutter->text();
    const auto milled = mill_rough(*part, o);
    if (!milled) {
      EXPECT_EQ(milled.error().code, ErrorCode::input) << what << ": " << milled.error().text() << "\n" << c;
      continue;
    }
    ++done;
    const double scale = std::max((*part)->extent(), radius);
    const Point3 origin = (*part)->origin();
    StockOptions block;
    block.cell = radius / 7, block.top = *o.stock_top;
    const auto left = Simulation::run(milled->path, **part, *o.tool.cutter, block);
    ASSERT_TRUE(left) << what << ": " << left.error().text();
    EXPECT_LE(left->report().rapid_cut.value, 1e-6 * scale) << what << ": rapid moves cut\n" << c;
    if (o.tool.cutter->kind() == Cutter::Kind::ball) {
      const double grown = radius + o.tool.allowance;
      const PathCheck check = check_path(**part, *part, milled->path, grown, grown + 1, (*part)->lowest().z + grown,
                                         radius / 12, 10, [](const Move&) { return false; });
      EXPECT_LE(check.deepest, 1e-9 * scale) << what << "\n" << c;
    } else {
      const TipHeights heights(*part, *o.tool.cutter, o.tool.allowance, (*part)->lowest().z + o.tool.allowance);
      const TipCheck check =
          check_tip(**part, heights, milled->path, 1e9, radius / 12, 10, [](const Move&) { return false; });
      EXPECT_LE(check.deepest, 1e-9 * scale)
          << what << " gouges at " << check.deepest_at.x + origin.x << " " << check.deepest_at.y + origin.y << "\n"
          << c;
    }
    if (HasFailure()) return;
  }
  EXPECT_GE(2 * done, cases);
}

TEST(Roughing, IsTheSameForAnyNumberOfThreads) {
  const auto part = bumps(3);
  RoughOptions o;
  o.tool.radius = 1.5, o.step_over = 1, o.step_down = 1.1;
  expect_same_from_any_threads([&](const Context& context) { return mill_rough(part, o, context); });
}

TEST(Roughing, ChecksItsOptions) {
  const auto part = bumps(1);
  RoughOptions o;
  o.tool.radius = 1;
  EXPECT_EQ(mill_rough(part, o).error().code, ErrorCode::usage);
  o.step_over = 1;
  EXPECT_EQ(mill_rough(part, o).error().code, ErrorCode::usage);
  o.step_down = 1, o.ramp_angle = 90;
  EXPECT_EQ(mill_rough(part, o).error().code, ErrorCode::usage);
  o.ramp_angle = 3, o.stock_top = -5;
  EXPECT_EQ(mill_rough(part, o).error().code, ErrorCode::usage);
}

}  // namespace
}  // namespace krepl::test
