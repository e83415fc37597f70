// Cutters over shapes whose answers are known: tangencies, walls, axes over vertices, level and equally steep faces.
#include <gtest/gtest.h>

#include <cmath>

#include "cutter_case.hpp"
#include "terrain/drop_cutter_search.hpp"

namespace krepl::test {

namespace {

using Contact = DropCutter::Contact;
using Kind = Terrain::FeatureKind;

Cutter tool(const char* text) { return *Cutter::parse(text); }

DropCutter over(const DropCase& c, const char* text) {
  Result<DropCutter> cutter = DropCutter::build(c.terrain, tool(text));
  EXPECT_TRUE(cutter.ok()) << cutter.error().text();
  return *cutter;
}

/// Checks against brute force as well.
Contact at(const DropCase& c, const char* text, Point place) {
  const Contact contact = over(c, text).at(place);
  const auto fault = cutter_fault(c, place, tool(text), contact);
  EXPECT_FALSE(fault) << *fault;
  return contact;
}

/// A roof: ridge along y at x = 0, height `top`, eaves at x = -10 and 10 at height 0.
DropCase roof(double top) {
  return mesh_case("roof", {{-10, -10, 0}, {0, -10, top}, {10, -10, 0}, {-10, 10, 0}, {0, 10, top}, {10, 10, 0}},
                   {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}});
}
/// A step of height 4 at x = 0, with its vertical wall.
DropCase step() {
  return mesh_case(
      "step",
      {{-10, -10, 4}, {0, -10, 4}, {0, 10, 4}, {-10, 10, 4}, {0, -10, 0}, {10, -10, 0}, {10, 10, 0}, {0, 10, 0}},
      {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}, {1, 4, 7}, {1, 7, 2}});
}

TEST(CutterShapes, LevelGroundIsTouchedUnderTheAxis) {
  const DropCase c = grid_case("flat", {5, 5, {0, 0}, 4, 4}, std::vector<double>(25, 0));
  for (const char* text : {"flat:6", "bull:6:1", "cone:6:90", "taper:6:20:1"}) {
    const Contact contact = at(c, text, {6.5, 7.25});
    EXPECT_EQ(contact.height, 0) << text;
    // Where the tool is level it touches faces, edges and vertices at once, of which vertices come first.
    const bool level = tool(text).flat_radius() > 0;
    EXPECT_TRUE(level || contact.point == (Point3{6.5, 7.25, 0})) << text;
    EXPECT_EQ(c.terrain->feature_kind(contact.feature), level ? Kind::vertex : Kind::face) << text;
    EXPECT_EQ(c.terrain->feature_kind(at(c, text, {8, 8}).feature), Kind::vertex) << text;
    EXPECT_EQ(at(c, text, {16 + 3, 8}).height, -tool(text).height(3)) << text;  // the rim over the border
    EXPECT_FALSE(at(c, text, {16 + 3.0000001, 8}).touches()) << text;
  }
}

TEST(CutterShapes, RidgesOfARoof) {
  const DropCase c = roof(10);  // slope 1
  const double root = std::sqrt(0.5);
  // Over the slope: the rim of a flat tool is uphill; a corner touches where it has the slope 1.
  EXPECT_NEAR(at(c, "flat:4", {5, 0.3}).height, 5 + 2, 1e-13);
  EXPECT_NEAR(at(c, "bull:4:1", {5, 0.3}).height, 5 + 1 + root - (1 - root), 1e-13);
  EXPECT_NEAR(at(c, "taper:4:60:1", {5, 0.3}).height, 5 + root - (1 - root), 1e-13);
  // A cone of the roof's own slope touches it from the axis outwards: at its tip.
  const Contact along = at(c, "cone:4:90", {5, 0.3});
  EXPECT_NEAR(along.height, 5, 1e-14);
  EXPECT_NEAR(along.point.x, 5, 1e-13);
  EXPECT_NEAR(at(c, "cone:4:150", {5, 0.3}).height, 5 + 2 - 2 * tool("cone:4:150").slope(),
              1e-13);  // a blunt one by its rim
  // Beside and over the ridge.
  EXPECT_EQ(at(c, "flat:4", {1.5, 1}).height, 10);
  EXPECT_EQ(c.terrain->feature_kind(at(c, "flat:4", {1.5, 1}).feature), Kind::edge);
  EXPECT_EQ(at(c, "cone:4:90", {0, 1}).height, 10);
  EXPECT_EQ(at(c, "bull:4:1", {0, 1}).height, 10);
  EXPECT_NEAR(at(c, "bull:4:1", {1.5, 1}).height, 10 - (1 - std::sqrt(0.75)), 1e-13);
}

TEST(CutterShapes, BesideAWall) {
  const DropCase c = step();
  // The rim touches the wall's upper edge exactly, a shank beside it does not.
  for (const char* text : {"flat:6", "bull:6:1", "cone:6:60", "taper:6:20:0.5"}) {
    EXPECT_EQ(at(c, text, {3, 0.125}).height, 4 - tool(text).height(3) > 0 ? 4 - tool(text).height(3) : 0) << text;
    EXPECT_EQ(at(c, text, {3.0000001, 0.125}).height, 0) << text;
    EXPECT_EQ(at(c, text, {-1, 0.125}).height, 4) << text;
  }
}

TEST(CutterShapes, SteepSlantedEdgeUnderABullNose) {
  // An edge in the air, 1 beside the axis: brute force knows.
  const DropCase c = mesh_case("edge", {{-8, 1, -20}, {8, 1, 20}, {0, 1 + 1e-3, 0}}, {{0, 1, 2}});
  for (const double corner : {1e-6, 1e-3, 0.1, 1.0, 2.0, 2.9999, 3.0}) {
    const Cutter cutter = *Cutter::bull_nose(6, corner);
    for (const double x : {-8.0, -2.0, 0.0, 1e-9, 3.0, 7.99}) {
      const DropCutter drop = *DropCutter::build(c.terrain, cutter);
      for (const double y : {1.0, 0.0, -1.5, -2.0, 1 - 3 + 1e-9, 4.0005}) {
        const auto fault = cutter_fault(c, {x, y}, cutter, drop.at({x, y}));
        EXPECT_FALSE(fault) << *fault;
      }
    }
  }
}

TEST(CutterShapes, BallAsBullNoseIsABall) {
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    const DropCase c = drop_families()[0].make(random);
    const double r = c.cell * (0.3 + i % 5);
    const DropCutter ball = *DropCutter::build(c.terrain, r),
                     bull = *DropCutter::build(c.terrain, *Cutter::bull_nose(2 * r, r));
    for (int k = 0; k < 20; ++k) {
      const Point place = any_place(random, c, r);
      const Contact a = ball.at(place), b = bull.at(place);
      ASSERT_EQ(a.touches(), b.touches());
      if (!a.touches()) continue;
      EXPECT_NEAR(a.height - r, b.height, 1e-12 * c.scale(r));
    }
  }
}

TEST(CutterShapes, RadiiAndCornersOutOfRange) {
  const DropCase c = roof(3);
  EXPECT_FALSE(DropCutter::build(c.terrain, *Cutter::flat(1e-20)).ok());
  EXPECT_FALSE(DropCutter::build(c.terrain, *Cutter::flat(1e20)).ok());
  EXPECT_FALSE(DropCutter::build(c.terrain, *Cutter::bull_nose(1, 1e-17)).ok());
  EXPECT_TRUE(DropCutter::build(c.terrain, *Cutter::bull_nose(1, 1e-14)).ok());
  const Contact nowhere = over(c, "flat:1").at({std::nan(""), 0});
  EXPECT_FALSE(nowhere.touches());
}

/// The bounds that the search prunes by are above every sample of a part.
TEST(CutterShapes, BoundsAreAboveSamples) {
  using namespace drop;
  Random random(9);
  for (int i = 0; i < 4000; ++i) {
    const TestTool any = any_tool(random, 1);
    const ProfileTool profile(any.cutter);
    const ProfileBound tool(profile, 1, 1e-7);
    const double size = exponential(random, -2, 1), sx = uniform(random, -8, 8), sy = uniform(random, -8, 8);
    const double cx = uniform(random, -1.3, 1.3), cy = uniform(random, -1.3, 1.3);
    Point3 p[3];
    for (Point3& q : p) q = {cx + uniform(random, -size, size), cy + uniform(random, -size, size), 0};
    if ((p[1].x - p[0].x) * (p[2].y - p[0].y) < (p[1].y - p[0].y) * (p[2].x - p[0].x)) std::swap(p[1], p[2]);
    for (Point3& q : p) q.z = 2 + sx * q.x + sy * q.y;
    const auto [x0, x1] = std::minmax({p[0].x, p[1].x, p[2].x});
    const auto [y0, y1] = std::minmax({p[0].y, p[1].y, p[2].y});
    const float top = float(std::max({p[0].z, p[1].z, p[2].z}));
    const FourTriangles triangle{top,           float(p[0].z), float(sx),     float(sy),     float(p[0].x),
                                 float(p[0].y), float(p[1].x), float(p[1].y), float(p[2].x), float(p[2].y)};
    const FourBlocks block{top,       float(2 + sx * (x0 + x1) / 2 + sy * (y0 + y1) / 2),
                           float(sx), float(sy),
                           float(x0), float(x1),
                           float(y0), float(y1)};
    float by_triangle[4], by_block[4];
    bound(tool, triangle, OnePlace{}).store(by_triangle);
    bound(tool, block, OnePlace{}).store(by_block);
    double highest = -1e30;
    for (int k = 0; k <= 20; ++k)
      for (int j = 0; j + k <= 20; ++j) {
        const double v = k / 20.0, w = j / 20.0, u = 1 - v - w;
        const double x = u * p[0].x + v * p[1].x + w * p[2].x, y = u * p[0].y + v * p[1].y + w * p[2].y;
        if (const double r = std::hypot(x, y); r <= 1)
          highest = std::max(highest, 2 + sx * x + sy * y - double(any.height(r)));
      }
    if (highest < -1e29) continue;  // all samples are out of reach
    const double slack = ProfileBound::slack_per_radius + 0x1p-18 * 20 * (1 + size);
    ASSERT_GE(by_triangle[0] + slack, highest) << any.cutter.text() << " case " << i;
    ASSERT_GE(by_block[0] + slack, highest) << any.cutter.text() << " case " << i;
  }
}

}  // namespace

}  // namespace krepl::test
