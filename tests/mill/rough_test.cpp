// Roughing by brute force: never in the part and its allowance, never rapidly through stock, and the stock is gone
// afterwards where the tool has room.
#include <gtest/gtest.h>

#include <random>

#include "mill/path_check.hpp"
#include "support/environment.hpp"

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
  for (int k = 0; k < 6; ++k) {
    const auto part = bumps(seed() + std::uint64_t(k));
    RoughOptions o;
    o.tool.radius = 1.5, o.tool.allowance = 0.2 * (k % 3), o.step_over = 1, o.step_down = 1.1, o.angle = 45 * (k % 4);
    o.stock_margin = k % 2, o.ramp_angle = 5;
    if (k >= 4) o.stock_top = part->highest().z + part->origin().z + 1.3;
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
    Point3 before = milled->path.start;
    walk(milled->path, 0.15, 1, [&](Point3 p, const Move& m) {
      const double depth = stock.cut(p, o.tool.radius);
      if (m.kind == MoveKind::rapid) rapid_depth = std::max(rapid_depth, depth);
      // Into stock it goes down by ramps only.
      const double along = std::hypot(p.x - before.x, p.y - before.y), down = before.z - p.z;
      if (down > 1e-9 && depth > 0.1) steepest = std::max(steepest, std::atan2(down, along));
      before = p;
    });
    EXPECT_LE(rapid_depth, 1e-9) << "case " << k << ": a rapid move cuts";
    EXPECT_LE(steepest, 5.01 * std::numbers::pi / 180) << "case " << k;

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
