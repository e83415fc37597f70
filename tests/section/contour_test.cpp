// Contours against heights of the drop cutter, which knows nothing of the subdivision.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cut_case.hpp"
#include "section/nesting.hpp"
#include "support/environment.hpp"

namespace krepl::test {

namespace {

void expect_sound(const CutCase& c, double level, bool ties_are_high = true, int grid = 24) {
  const Result<Contour> contour = c.cuts->contour(level, {ties_are_high});
  ASSERT_TRUE(contour.ok()) << contour.error().text() << "\n" << c.name;
  const auto fault = fault_of(c, *contour, grid);
  EXPECT_FALSE(fault) << *fault << "\nlevel " << level << "\n" << c.name;
}

TEST(Contour, OfAPeakIsACircle) {
  const auto c = make_case(grid_of(3, 3, [](auto x, auto y) { return x == 1 && y == 1 ? 10.0 : 0.0; }), 2, "peak");
  ASSERT_TRUE(c);
  const double top = c->terrain->highest().z, level = top + std::sqrt(3);
  const Result<Contour> contour = c->cuts->contour(level);
  ASSERT_TRUE(contour.ok());
  ASSERT_EQ(contour->ring_count(), 1u);
  ASSERT_EQ(contour->pieces.size(), 1u);
  EXPECT_EQ(contour->pieces[0].kind, CutPiece::Kind::circle);
  EXPECT_NEAR(section::ring_area(contour->ring(0)), std::numbers::pi, 1e-12);
  EXPECT_EQ(c->cuts->contour(top + 2.001)->ring_count(), 0u);
  EXPECT_EQ(c->cuts->contour(top - 1000)->ring_count(), 1u);  // the silhouette of all
}

TEST(Contour, OfFlatGroundAtTheLevelIsDecidedAsOne) {
  const auto c = make_case(grid_of(4, 4, [](auto, auto) { return 5.0; }), 0.5, "flat");
  ASSERT_TRUE(c);
  const double level = c->terrain->highest().z + 0.5;
  const Result<Contour> high = c->cuts->contour(level), low = c->cuts->contour(level, {false});
  ASSERT_TRUE(high.ok() && low.ok());
  ASSERT_EQ(high->ring_count(), 1u);
  EXPECT_NEAR(section::ring_area(high->ring(0)), 9, 1e-4);
  EXPECT_EQ(low->ring_count(), 0u);
}

TEST(Contour, OfAPitIsAHoleWithAnIslandInIt) {
  const auto c = make_case(grid_of(21, 21,
                                   [](auto x, auto y) {
                                     const double r = std::max(std::abs(double(x) - 10), std::abs(double(y) - 10));
                                     return r < 1 ? 10.0 : r < 8 ? 0.0 : 10.0;
                                   }),
                           0.7, "pit");
  ASSERT_TRUE(c);
  const Result<Contour> contour = c->cuts->contour(c->terrain->lowest().z + 5);
  ASSERT_TRUE(contour.ok());
  ASSERT_EQ(contour->ring_count(), 3u);
  int holes = 0, deep = 0;
  for (std::size_t r = 0; r < 3; ++r) {
    holes += contour->ring_is_hole[r];
    deep += contour->ring_parent[r] != Contour::none && contour->ring_is_hole[contour->ring_parent[r]];
  }
  EXPECT_EQ(holes, 1);
  EXPECT_EQ(deep, 1);
  expect_sound(*c, contour->level, true, 60);
}

TEST(Contour, RandomSmallTerrains) {
  Random random(seed());
  const int cases = int(24 * effort());
  int made = 0;
  for (int i = 0; i < cases; ++i) {
    const auto c = make_case(random_small_terrain(random, i));
    if (!c || !c->is_sound()) continue;
    ++made;
    const double low = c->terrain->lowest().z, high = c->terrain->highest().z + c->surface->radius();
    for (int k = 0; k < 4; ++k) expect_sound(*c, uniform(random, low, high));
    // On slopes above 16 what is tangent to a level at a vertex may be missed (docs/section.md).
    const bool is_steep = SmallTerrainFamily(i % int(SmallTerrainFamily::count)) == SmallTerrainFamily::steep;
    for (int k = 0; k < 4 && !is_steep; ++k)  // where vertices, flat faces and tops are
      expect_sound(*c, c->surface->vertex(Surface::Index(random() % c->surface->subdivision().vertex_count)).z,
                   k % 2 == 0);
    expect_sound(*c, high);
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(made, cases / 2);
}

TEST(Contour, SmoothTerrain) {
  Random random(seed());
  const auto c =
      make_case(grid_of(40, 40,
                        [](auto x, auto y) {
                          return 4 * std::sin(0.31 * double(x)) * std::cos(0.27 * double(y)) + 0.02 * double(x);
                        }),
                1.3, "waves");
  ASSERT_TRUE(c);
  for (int k = 0; k < 10; ++k)
    expect_sound(*c, uniform(random, c->terrain->lowest().z, c->terrain->highest().z + 1.3), true, 80);
}

TEST(Contour, SeveralAtOnceAreTheSame) {
  const auto c = make_case(grid_of(20, 20, [](auto x, auto y) { return double((x * 7 + y * 13) % 5); }), 0.8, "noise");
  ASSERT_TRUE(c);
  std::vector<double> levels;
  for (int i = 0; i < 20; ++i) levels.push_back(c->terrain->lowest().z + 0.3 * i);
  Context two;
  two.threads = 2;
  const auto all = c->cuts->contours(levels, {}, two);
  ASSERT_TRUE(all.ok());
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const Result<Contour> one = c->cuts->contour(levels[i]);
    ASSERT_EQ(one->pieces.size(), (*all)[i].pieces.size());
    for (std::size_t k = 0; k < one->pieces.size(); ++k) EXPECT_EQ(one->pieces[k].start, (*all)[i].pieces[k].start);
  }
}

TEST(Contour, ALevelHasToBeFinite) {
  const auto c = make_case(grid_of(2, 2, [](auto, auto) { return 0.0; }), 1, "square");
  ASSERT_TRUE(c);
  EXPECT_FALSE(c->cuts->contour(std::nan("")).ok());
}

}  // namespace

}  // namespace krepl::test
