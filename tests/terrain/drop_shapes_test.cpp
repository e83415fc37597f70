// Heights and touched features that can be worked out by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "drop_terrains.hpp"

namespace krepl::test {

namespace {

using Kind = Terrain::FeatureKind;
using Contact = DropCutter::Contact;

Contact drop(const DropCase& c, double radius, Point place) {
  const Result<DropCutter> cutter = DropCutter::build(c.terrain, radius);
  EXPECT_TRUE(cutter.ok());
  return cutter->at(place);
}

/// `height` as text, one row a line from the south; samples at whole numbers.
DropCase grid(std::size_t columns, std::vector<double> heights, Terrain::Split split = Terrain::Split::rising) {
  Terrain::Grid g;
  g.columns = columns, g.rows = heights.size() / columns, g.split = split;
  return grid_case("grid", g, std::move(heights));
}

void expect_point(Point3 a, Point3 b) {
  EXPECT_NEAR(a.x, b.x, 1e-13);
  EXPECT_NEAR(a.y, b.y, 1e-13);
  EXPECT_NEAR(a.z, b.z, 1e-13);
}

TEST(DropShapes, FlatGroundTouchesWhatIsBelow) {
  const DropCase c = grid(4, std::vector<double>(16, 5.0));
  const double flat = 5 - c.terrain->origin().z;
  for (const double radius : {0.01, 0.5, 2.0, 100.0}) {
    const Contact corner = drop(c, radius, {1, 2}), side = drop(c, radius, {1.5, 2}), diagonal = drop(c, radius, {1.25, 2.25});
    const Contact inside = drop(c, radius, {1.75, 2.125});
    for (const Contact& contact : {corner, side, diagonal, inside}) EXPECT_EQ(contact.height, flat + radius);
    EXPECT_EQ(corner.feature, 6u * 9);          // sample (1, 2)
    EXPECT_EQ(side.feature, 6u * 9 + 1);        // its edge to +x
    EXPECT_EQ(diagonal.feature, 6u * 9 + 3);    // its diagonal
    EXPECT_EQ(inside.feature, 6u * 9 + 4);      // the triangle below it
    expect_point(inside.point, {1.75, 2.125, flat});
  }
}

TEST(DropShapes, SlopeTouchesWhereItIsNormal) {
  // z = 3 x / 4: the normal is (-3, 0, 4) / 5.
  const DropCase c = grid(9, [] {
    std::vector<double> z;
    for (int j = 0; j < 9; ++j)
      for (int i = 0; i < 9; ++i) z.push_back(0.75 * i);
    return z;
  }());
  const Point3 o = c.terrain->origin();
  const Contact contact = drop(c, 2.5, {3.0 - o.x, 4.25 - o.y});
  EXPECT_NEAR(contact.height + o.z, 0.75 * 3 + 2.5 * 1.25, 1e-13);
  EXPECT_EQ(c.terrain->feature_kind(contact.feature), Kind::face);
  expect_point(contact.point, {4.5 - o.x, 4.25 - o.y, 0.75 * 4.5 - o.z});
  // The touched point on the side between two cells: the edge, though both faces are in one plane with it.
  const Contact on_edge = drop(c, 2.5, {2.5 - o.x, 4.25 - o.y});
  EXPECT_EQ(on_edge.feature, 6u * (4 * 9 + 4) + 2);
  EXPECT_EQ(drop(c, 2.5, {2.5 - o.x, 4.0 - o.y}).feature, 6u * (4 * 9 + 4));
}

TEST(DropShapes, PeakRidgeAndRimAreExact) {
  const DropCase peak =
      mesh_case("peak", {{-9, -9, -90}, {9, -9, -90}, {0, 9, -90}, {0, 0, 0}}, {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
  const Contact summit = drop(peak, 5, {3, 0});
  EXPECT_DOUBLE_EQ(summit.height + peak.terrain->origin().z, 4.0);
  EXPECT_EQ(peak.terrain->feature_kind(summit.feature), Kind::vertex);
  // 3, 4, 5: the place is at distance R from the corner, which the ball just touches with its equator.
  const Contact corner = drop(grid(3, std::vector<double>(9, 0.0)), 5, {5, 6});
  EXPECT_EQ(corner.height, 0);
  EXPECT_EQ(corner.feature, 6u * 8);

  const DropCase ridge = mesh_case("ridge", {{0, 0, 0}, {8, 0, 0}, {4, 9, -90}, {4, -9, -90}}, {{0, 1, 2}, {1, 0, 3}});
  const Contact on_ridge = drop(ridge, 5, {4 - ridge.terrain->origin().x, 3});
  EXPECT_DOUBLE_EQ(on_ridge.height + ridge.terrain->origin().z, 4.0);
  EXPECT_EQ(ridge.terrain->feature_kind(on_ridge.feature), Kind::edge);
}

TEST(DropShapes, NothingBelowTouchesNothing) {
  const DropCase c = grid(3, std::vector<double>(9, 0.0));
  EXPECT_TRUE(drop(c, 1, {3, 1}).touches());           // at distance R exactly
  EXPECT_EQ(drop(c, 1, {3, 1}).height, 0);
  EXPECT_FALSE(drop(c, 1, {std::nextafter(3, 4), 1}).touches());
  EXPECT_FALSE(drop(c, 1, {3, 2.001}).touches());
  EXPECT_EQ(drop(c, 1, {4, 4}).height, -INFINITY);
  EXPECT_EQ(drop(c, 1, {4, 4}).feature, Terrain::none);
  EXPECT_FALSE(drop(c, 1, {NAN, 1}).touches());
  EXPECT_FALSE(drop(c, 1, {1, -INFINITY}).touches());
  EXPECT_FALSE(drop(c, 1, {1e300, 1e300}).touches());
}

TEST(DropShapes, HoleIsFallenThrough) {
  std::vector<double> z(100, 0.0);
  for (int j = 2; j < 8; ++j)
    for (int i = 2; i < 8; ++i) z[std::size_t(10 * j + i)] = NAN;
  const DropCase c = grid(10, z);
  EXPECT_FALSE(drop(c, 2, {4.5, 4.5}).touches());
  EXPECT_TRUE(drop(c, 4, {4.5, 4.5}).touches());
}

TEST(DropShapes, TieGoesToTheLowestNumber) {
  // Two summits of one height, and the place half way.
  std::vector<double> z(7 * 3, -50.0);
  z[7 + 1] = z[7 + 5] = 0;
  const DropCase c = grid(7, z);
  const Contact contact = drop(c, 3, {3, 1});
  EXPECT_EQ(contact.feature, 6u * 8);
  EXPECT_DOUBLE_EQ(contact.height + c.terrain->origin().z, std::sqrt(5.0));
}

TEST(DropShapes, VerticalWallCountsByItsUpperEdge) {
  const DropCase c = mesh_case("wall", {{0, 0, 0}, {8, 0, 0}, {8, 0, 3}, {0, 0, 3}}, {{0, 1, 2}, {0, 2, 3}});
  const Point3 o = c.terrain->origin();
  const Contact above = drop(c, 5, {4 - o.x, 3 - o.y});
  EXPECT_DOUBLE_EQ(above.height + o.z, 7.0);
  EXPECT_EQ(c.terrain->feature_kind(above.feature), Kind::edge);
  EXPECT_NEAR(above.point.z + o.z, 3, 1e-13);
  EXPECT_EQ(c.terrain->feature_kind(drop(c, 5, {11 - o.x, -o.y}).feature), Kind::vertex);
}

TEST(DropShapes, OverhangCountsByItsUpperSide) {
  // A table: a plate of thickness 1 at height 4 over a floor.
  const DropCase c = mesh_case(
      "table",
      {{-9, -9, 0}, {9, -9, 0}, {0, 12, 0}, {-2, -2, 4}, {2, -2, 4}, {0, 3, 4}, {-2, -2, 5}, {2, -2, 5}, {0, 3, 5}},
      {{0, 1, 2}, {3, 5, 4}, {6, 7, 8}});
  const Point3 o = c.terrain->origin();
  const Contact contact = drop(c, 1, {-o.x, -o.y});
  EXPECT_DOUBLE_EQ(contact.height + o.z, 6.0);
}

TEST(DropShapes, RadiiFarBelowAndFarAboveTheTerrain) {
  Random random(7);
  const DropCase c = drop_families()[0].make(random);
  for (const double factor : {1e-9, 1e-6, 1e3, 1e6, 1e9, 1e12}) {
    const double radius = factor * c.cell;
    const Result<DropCutter> cutter = DropCutter::build(c.terrain, radius);
    ASSERT_TRUE(cutter.ok());
    for (int k = 0; k < 40; ++k) {
      const Point place = any_place(random, c, radius);
      const auto fault = fault_of(c, place, radius, cutter->at(place));
      EXPECT_FALSE(fault) << *fault;
    }
  }
}

}  // namespace

}  // namespace krepl::test
