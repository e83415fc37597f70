// Sections against heights of the drop cutter, which knows nothing of the subdivision.
#include <gtest/gtest.h>

#include <cmath>

#include "cut_case.hpp"
#include "support/environment.hpp"

namespace krepl::test {

namespace {

void expect_sound(const CutCase& c, Point from, Point to, int places = 60) {
  const Result<Section> section = c.cuts->section(from, to);
  ASSERT_TRUE(section.ok()) << section.error().text() << "\n" << c.name;
  const auto fault = fault_of(c, *section, places);
  EXPECT_FALSE(fault) << *fault << "\nfrom " << from.x << ", " << from.y << " to " << to.x << ", " << to.y << "\n"
                      << c.name;
}

Point any_place(Random& random, const CutCase& c) {
  const Point3 low = c.terrain->lowest(), high = c.terrain->highest();
  const double r = 1.5 * c.surface->radius();
  return {uniform(random, low.x - r, high.x + r), uniform(random, low.y - r, high.y + r)};
}

TEST(Section, OfASquareIsItsParallelCurve) {
  const auto c = make_case(grid_of(2, 2, [](auto, auto) { return 0.0; }), 1, "square");
  ASSERT_TRUE(c);
  const Point3 low = c->terrain->lowest(), high = c->terrain->highest();
  const double y = low.y + 0.3 * (high.y - low.y);
  const Result<Section> section = c->cuts->section({low.x - 3, y}, {high.x + 3, y});
  ASSERT_TRUE(section.ok());
  ASSERT_EQ(section->chain_count(), 1u);
  double along = low.x - 1;
  int circles = 0;
  for (const CutPiece& piece : section->pieces) {
    EXPECT_NEAR(piece.start.x, along, 1e-11);
    along = piece.end.x;
    circles += piece.kind == CutPiece::Kind::circle;
  }
  EXPECT_NEAR(along, high.x + 1, 1e-11);
  EXPECT_EQ(circles, 2);
  EXPECT_NEAR(section->pieces.front().at(0.5).z, low.z + std::sqrt(0.5), 1e-12);
}

TEST(Section, IsCutOffAtTheEndsOfTheLine) {
  const auto c = make_case(grid_of(3, 3, [](auto x, auto) { return x == 1 ? 1.0 : 0.0; }), 0.4, "ridge");
  ASSERT_TRUE(c);
  const Result<Section> section = c->cuts->section({0.3, 1.2}, {1.1, 0.7});
  ASSERT_TRUE(section.ok());
  ASSERT_EQ(section->chain_count(), 1u);
  EXPECT_NEAR(section->pieces.front().start.x, 0.3, 1e-12);
  EXPECT_NEAR(section->pieces.back().end.y, 0.7, 1e-12);
}

TEST(Section, RandomSmallTerrains) {
  Random random(seed());
  const int cases = int(36 * effort());
  int made = 0;
  for (int i = 0; i < cases; ++i) {
    const auto c = make_case(random_small_terrain(random, i));
    if (!c || !c->is_sound()) continue;
    ++made;
    const auto vertex = [&] {  // but for those where walls are tangent, which are known less well
      for (;;) {
        const Point3 p = c->surface->vertex(Surface::Index(random() % c->surface->subdivision().vertex_count));
        if (c->passes(p, 1e-11 * c->scale())) return Point{p.x, p.y};
      }
    };
    for (int k = 0; k < 3; ++k) expect_sound(*c, any_place(random, *c), any_place(random, *c));
    for (int k = 0; k < 2; ++k) {  // through vertices, and along rows and columns
      const Point a = vertex(), b = vertex();
      if (!(a == b)) expect_sound(*c, a, b);
      expect_sound(*c, a, k == 0 ? Point{a.x + 3, a.y} : Point{a.x, a.y + 3});
    }
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(made, cases / 2);
}

TEST(Section, AlongRowsOfSamples) {
  const auto c = make_case(grid_of(12, 12, [](auto x, auto y) { return double((x * 5 + y * 3) % 4); }), 0.6, "noise");
  ASSERT_TRUE(c);
  const Point3 low = c->terrain->lowest(), high = c->terrain->highest();
  for (int i = 0; i < 12; ++i) {
    const double y = low.y + i, x = low.x + i;
    expect_sound(*c, {low.x - 1, y}, {high.x + 1, y}, 300);
    expect_sound(*c, {x, high.y + 1}, {x, low.y - 1}, 300);
  }
}

TEST(Section, ALineHasToHaveTwoEnds) {
  const auto c = make_case(grid_of(2, 2, [](auto, auto) { return 0.0; }), 1, "square");
  ASSERT_TRUE(c);
  EXPECT_FALSE(c->cuts->section({0, 0}, {0, 0}).ok());
  EXPECT_FALSE(c->cuts->section({0, 0}, {0, std::nan("")}).ok());
  EXPECT_EQ(c->cuts->section({10, 10}, {20, 10})->chain_count(), 0u);
}

}  // namespace

}  // namespace krepl::test
