// Whole simulations: what is known in closed form, drop-cutter passes that must not gouge, gouges and rapids that are
// made.
#include "krepl/simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/environment.hpp"
#include "terrain/cutter_case.hpp"

namespace krepl::test {

namespace {

Move line(Point3 end, double feed = 100) { return {MoveKind::line, ArcPlane::xy, end, {}, feed}; }
Move rapid(Point3 end) { return {MoveKind::rapid, ArcPlane::xy, end, {}, 0}; }

/// A level part at height 2, 40 by 30, its lower left corner at (100, 200).
DropCase table() { return grid_case("table", {5, 4, {100, 200}, 10, 10}, std::vector<double>(20, 2)); }

Simulation simulate(const ToolPath& path, const Terrain& part, const Cutter& cutter, const StockOptions& stock) {
  Result<Simulation> result = Simulation::run(path, part, cutter, stock);
  EXPECT_TRUE(result.ok()) << result.error().text();
  return *result;
}

TEST(Block, AGrooveOfABall) {
  const DropCase c = table();
  ToolPath path{{110, 215, 20},
                {line({110, 215, 7}), line({130, 215, 7}), rapid({130, 215, 20})}};  // centres; radius 3
  StockOptions stock;
  stock.cell = 0.25, stock.margin = 1, stock.top = 6;
  const Simulation s = simulate(path, *c.terrain, *Cutter::ball(6), stock);
  EXPECT_EQ(s.report().gouge.value, 0);
  EXPECT_EQ(s.report().cutting_rapids, 0u);
  EXPECT_DOUBLE_EQ(s.report().cutting_length, 33);
  EXPECT_DOUBLE_EQ(s.report().cutting_minutes, 0.33);
  EXPECT_DOUBLE_EQ(s.report().rapid_length, 13);
  EXPECT_EQ(s.report().rest.value, 4);  // uncut
  // A cap of height 2 of a circle of radius 3, over the length, and of a ball at both ends.
  const double half = std::acos(1.0 / 3), segment = 9 * half - std::sqrt(8.0);
  const double cap = std::numbers::pi * 4 * (9 - 2) / 3;
  EXPECT_NEAR(s.report().removed_volume, 20 * segment + cap, 0.5);
  for (std::size_t row = 0; row < s.rows(); ++row)
    for (std::size_t column = 0; column < s.columns(); ++column) {
      const Point p = s.place(column, row);
      const double x = std::max({110 - p.x, p.x - 130, 0.0}), d = std::hypot(x, p.y - 215);
      const double wanted = d <= 3 ? std::min(6.0, 7 - std::sqrt(9 - d * d)) : 6.0;
      ASSERT_NEAR(s.left()[row * s.columns() + column], wanted, 1e-12 * 215) << p.x << " " << p.y;
    }
}

TEST(Block, AGougeIsFoundWithItsDepth) {
  const DropCase c = table();
  ToolPath path{{110, 215, 20}, {rapid({110, 215, 5}), line({120, 215, 1.9}), line({130, 215, 5})}};
  StockOptions stock;
  stock.cell = 0.5, stock.top = 3;
  const Simulation s = simulate(path, *c.terrain, *Cutter::flat(6), stock);
  EXPECT_NEAR(s.report().gouge.value, 0.1, 1e-12);
  EXPECT_GT(s.report().gouged_dexels, 1u);
  EXPECT_LE(std::hypot(s.report().gouge.place.x - 120, s.report().gouge.place.y - 215), 3 + 1e-9);
  EXPECT_EQ(s.report().gouge.place.z, 2);
  EXPECT_NEAR(simulate(path, *c.terrain, *Cutter::cone(6, 90), stock).report().gouge.value, 0.1 * std::sqrt(0.5), 1e-9);
}

TEST(Block, ARapidThroughMaterialIsFound) {
  const DropCase c = table();
  StockOptions stock;
  stock.cell = 0.5, stock.top = 6;
  // Down beside the block, and through it.
  ToolPath path{
      {90, 215, 20},
      {rapid({90, 215, 4}), rapid({120, 215, 4}), line({130, 215, 4}), rapid({110, 215, 4}), rapid({110, 215, 9})}};
  const Simulation s = simulate(path, *c.terrain, *Cutter::flat(6), stock);
  EXPECT_EQ(s.report().cutting_rapids, 1u);
  EXPECT_EQ(s.report().rapid_cut.move, 1u);
  EXPECT_NEAR(s.report().rapid_cut.value, 2, 1e-9);
  EXPECT_EQ(s.report().gouge.value, 0);
}

TEST(Block, OnePathAfterAnother) {
  const DropCase c = table();
  StockOptions stock;
  stock.cell = 0.5, stock.top = 6;
  const ToolPath first{{90, 215, 20}, {rapid({90, 215, 3}), line({150, 215, 3})}};
  const ToolPath second{{90, 215, 20}, {rapid({90, 215, 3}), rapid({150, 215, 3}), line({150, 215, 2})}};
  const Simulation a = simulate(first, *c.terrain, *Cutter::flat(6), stock);
  EXPECT_EQ(simulate(second, *c.terrain, *Cutter::flat(4), stock).report().cutting_rapids, 1u);
  const Result<Simulation> b = Simulation::run(second, *c.terrain, *Cutter::flat(4), stock, {}, &a);
  ASSERT_TRUE(b.ok()) << b.error().text();
  EXPECT_EQ(b->report().cutting_rapids, 0u);
  for (std::size_t d = 0; d < a.left().size(); ++d) ASSERT_LE(b->left()[d], a.left()[d]);
  EXPECT_GT(Simulation::run(second, *c.terrain, *Cutter::flat(8), stock, {}, &a)->report().cutting_rapids, 0u);
  stock.cell = 0.25;
  EXPECT_FALSE(Simulation::run(second, *c.terrain, *Cutter::flat(4), stock, {}, &a).ok());
}

TEST(Block, HelixAndFullCircle) {
  const DropCase c = table();
  // Down a helix of radius 4 about (115, 215), then a full circle, all at heights above the part.
  Move down{MoveKind::counter_clockwise, ArcPlane::xy, {119, 215, 2}, {115, 215, 0}, 50};
  Move around = down;
  ToolPath path{{119, 215, 6}, {down, around}};
  StockOptions stock;
  stock.cell = 0.25, stock.top = 6;
  const Simulation s = simulate(path, *c.terrain, *Cutter::flat(6), stock);
  EXPECT_EQ(s.report().gouge.value, 0);
  const double turn = 8 * std::numbers::pi;
  EXPECT_NEAR(s.report().cutting_length, std::hypot(turn, 4) + turn, 1e-9);
  for (std::size_t d = 0; d < s.left().size(); ++d) {
    const Point p = s.place(d % s.columns(), d / s.columns());
    const double r = std::hypot(p.x - 115, p.y - 215);
    if (std::abs(r - 1) < 1e-3 || std::abs(r - 7) < 1e-3) continue;
    ASSERT_NEAR(s.left()[d], r > 1 && r < 7 ? 2 : 6, 1e-12);
  }
}

/// Passes whose places are let down by the drop cutter never gouge at those places; between them chords may, so places
/// are dense and lifted by what a chord can be below: found by the drop cutter in the middle.
TEST(Block, PassesOfTheDropCutterOnlyTouch) {
  Random random(seed());
  for (const std::size_t family : {0, 2, 7, 10}) {
    const DropCase c = drop_families()[family].make(random);
    for (const char* text : {"ball:3", "flat:3", "bull:3:0.5", "cone:3:90", "taper:3:40:0.5"}) {
      const Cutter cutter = *Cutter::parse(text);
      const DropCutter drop = *DropCutter::build(c.terrain, cutter);
      const Point3 low = c.terrain->lowest(), high = c.terrain->highest(), origin = c.terrain->origin();
      ToolPath path;
      // Each place alone: plunges to where the tool rests, and back.
      for (int k = 0; k < 60; ++k) {
        const Point p{uniform(random, low.x, high.x), uniform(random, low.y, high.y)};
        const DropCutter::Contact contact = drop.at(p);
        if (!contact.touches()) continue;
        const Point3 up{p.x + origin.x, p.y + origin.y, high.z + 5 + origin.z};
        if (path.moves.empty()) path.start = up;
        path.moves.push_back(rapid(up));
        path.moves.push_back(line({up.x, up.y, contact.height + origin.z}));
        path.moves.push_back(rapid(up));
      }
      StockOptions stock;
      stock.cell = std::max(high.x - low.x, high.y - low.y) / 150, stock.top = high.z + origin.z + 1e-6;
      const Simulation s = simulate(path, *c.terrain, cutter, stock);
      EXPECT_EQ(s.report().gouge.value, 0) << c.name << " " << text;
      EXPECT_EQ(s.report().cutting_rapids, 0u) << c.name << " " << text << " " << s.report().rapid_cut.value;
      // The same a little deeper gouges, as long as a dexel is near what is touched.
      for (Move& move : path.moves)
        if (move.kind == MoveKind::line) move.end.z -= 0.5;
      EXPECT_GT(simulate(path, *c.terrain, cutter, stock).report().gouge.value, 0.01) << c.name << " " << text;
    }
  }
}

TEST(Block, SameBitsForAnyNumberOfThreads) {
  Random random(seed() + 3);
  const DropCase c = drop_families()[0].make(random);
  const Point3 low = c.terrain->lowest(), high = c.terrain->highest(), origin = c.terrain->origin();
  ToolPath path{{origin.x + low.x, origin.y + low.y, origin.z + high.z + 5}, {}};
  for (int k = 0; k < 100; ++k)
    path.moves.push_back((k % 5 == 0 ? rapid : [](Point3 p) { return line(p); })(
        {origin.x + uniform(random, low.x, high.x), origin.y + uniform(random, low.y, high.y),
         origin.z + uniform(random, low.z, high.z)}));
  StockOptions stock;
  stock.cell = (high.x - low.x) / 130;
  Context one, five;
  one.threads = 1, five.threads = 5;
  const Cutter cutter = *Cutter::bull_nose(2 * c.cell, c.cell / 3);
  const Simulation a = *Simulation::run(path, *c.terrain, cutter, stock, one),
                   b = *Simulation::run(path, *c.terrain, cutter, stock, five);
  EXPECT_EQ(a.left(), b.left());
  EXPECT_EQ(a.gouge(), b.gouge());
  EXPECT_EQ(a.report().gouge.place, b.report().gouge.place);
  EXPECT_EQ(a.report().removed_volume, b.report().removed_volume);
  EXPECT_EQ(a.report().cutting_rapids, b.report().cutting_rapids);
  EXPECT_GT(a.report().cutting_rapids, 0u);
}

TEST(Block, WhatIsRefused) {
  const DropCase c = table();
  const Cutter cutter = *Cutter::flat(6);
  const ToolPath path{{110, 215, 20}, {line({110, 215, 7})}};
  const auto refused = [&](double cell, double margin, double top) {
    return !Simulation::run(path, *c.terrain, cutter, {cell, margin, top}).ok();
  };
  const double nan = std::nan("");
  EXPECT_TRUE(refused(0, 0, nan));
  EXPECT_TRUE(refused(nan, 0, nan));
  EXPECT_TRUE(refused(1e-6, 0, nan));
  EXPECT_TRUE(refused(1, -1, nan));
  EXPECT_TRUE(refused(1, 0, 1.5));
  EXPECT_FALSE(refused(1, 0, 2));
  ToolPath wrong = path;
  wrong.moves[0].end.z = nan;
  EXPECT_FALSE(Simulation::run(wrong, *c.terrain, cutter, {1, 0, 5}).ok());
}

}  // namespace

}  // namespace krepl::test
