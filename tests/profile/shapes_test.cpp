// Small terrains whose boundary can be written down.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "terrain_case.hpp"

namespace krepl::test {

namespace {

using Kind = ProfilePiece::Kind;
constexpr double down = -std::numeric_limits<double>::infinity();

/// Nine digits; what is zero but for rounding is zero.
double shown(double x) { return std::fabs(x) < 1e-12 ? 0 : x; }

/// A boundary as text: kind, cause and end of each piece.
std::string shape(const Terrain& terrain, double radius) {
  const Profile profile = profile_of(terrain, radius);
  std::string result;
  for (std::size_t k = 0; k < profile.pieces.size(); ++k) {
    const ProfileRow row = profile.row(k);
    char text[100];
    std::snprintf(text, sizeof text, "%s%c%s(%.9g %.9g)", k == 0 ? "" : " ",
                  "has"[row.kind == Kind::half_line ? 0 : row.kind == Kind::arc ? 1 : 2],
                  profile_cause(row).c_str(), shown(row.end.x), shown(row.end.y));
    result += text;
  }
  const auto fault = fault_in(terrain, radius);
  return fault ? *fault : result;
}

TEST(Shapes, OnePoint) { EXPECT_EQ(shape({{3, 4}}, 2), "hv0(1 4) av0(5 4) hv0(5 -inf)"); }

TEST(Shapes, OnePointGivenOften) {
  EXPECT_EQ(shape({{3, 4}, {3, 4}, {3, 4}}, 2), "hv0(1 4) av0(5 4) hv0(5 -inf)");
}

TEST(Shapes, FlatGroundHasNoArcsInside) {
  EXPECT_EQ(shape({{0, 1}, {1, 1}, {3, 1}, {4, 1}}, 2),
            "hv0(-2 1) av0(0 3) ss0(1 3) ss1(3 3) ss2(4 3) av3(6 1) hv3(6 -inf)");
}

TEST(Shapes, Ridge) {
  EXPECT_EQ(shape({{0, 0}, {3, 4}, {6, 0}}, 5),
            "hv0(-5 0) av0(-4 3) ss0(-1 7) av1(7 7) ss1(10 3) av2(11 0) hv2(11 -inf)");
}

TEST(Shapes, ValleyWithOneExplicitVertex) {
  EXPECT_EQ(shape({{0, 8}, {6, 0}, {12, 8}}, 5), "hv0(-5 8) av0(4 11) ss0(6 8.33333333) ss1(8 11) av2(17 8) hv2(17 -inf)");
}

TEST(Shapes, ValleyTooNarrowForTheDisk) {
  // The disk rests on both rims: centre at height sqrt(25 - 9) above them.
  EXPECT_EQ(shape({{-3, 0}, {0, -9}, {3, 0}}, 5), "hv0(-8 0) av0(0 4) av2(8 0) hv2(8 -inf)");
}

TEST(Shapes, StepUpIsAWallAtDistance) {
  EXPECT_EQ(shape({{0, 0}, {5, 0}, {5, 3}, {9, 3}}, 1),
            "hv0(-1 0) av0(0 1) ss0(4 1) ss1(4 3) av2(5 4) ss2(9 4) av3(10 3) hv3(10 -inf)");
}

TEST(Shapes, LowStepHasNoWall) {
  // The step is lower than R: the disk touches floor and upper edge at once.
  EXPECT_EQ(shape({{0, 0}, {5, 0}, {5, 1}, {9, 1}}, 5),
            "hv0(-5 0) av0(0 5) ss0(2 5) av2(5 6) ss2(9 6) av3(14 1) hv3(14 -inf)");
}

TEST(Shapes, WallsAtBothEnds) {
  EXPECT_EQ(shape({{0, 0}, {0, 2}, {4, 2}, {4, -1}}, 1),
            "hv0(-1 0) ss0(-1 2) av1(0 3) ss1(4 3) av2(5 2) ss2(5 -1) hv3(5 -inf)");
}

TEST(Shapes, WallGoingUpAndDownAtOnePlace) {
  // s0 to 6, back to 3, s2 to 10: the wall's offset is s0's up to 6 and s2's above. Falling, the same from the other side.
  EXPECT_EQ(shape({{0, 0}, {0, 6}, {0, 3}, {0, 10}, {0, 4}, {0, 5}, {0, 2}}, 1),
            "hv0(-1 0) ss0(-1 6) ss2(-1 10) av3(1 10) ss3(1 4) ss5(1 2) hv6(1 -inf)");
}

TEST(Shapes, SlitOfNoWidthIsClosed) {
  EXPECT_EQ(shape({{-2, 0}, {0, 0}, {0, -5}, {0, 0}, {2, 0}}, 1), "hv0(-3 0) av0(-2 1) ss0(0 1) ss3(2 1) av4(3 0) hv4(3 -inf)");
}

TEST(Shapes, SlotAsWideAsTheDisk) {
  // The disk just fits: it goes down along both walls at once, which leaves nothing to go down to.
  EXPECT_EQ(shape({{0, 5}, {1, 5}, {1, 0}, {5, 0}, {5, 5}, {6, 5}}, 2),
            "hv0(-2 5) av0(0 7) ss0(1 7) av1(3 5) av4(5 7) ss4(6 7) av5(8 5) hv5(8 -inf)");
  EXPECT_EQ(shape({{0, 5}, {1, 5}, {1, 0}, {5, 0}, {5, 3}, {6, 3}}, 2),
            "hv0(-2 5) av0(0 7) ss0(1 7) av1(3 5) ss1(3 3) av4(5 5) ss4(6 5) av5(8 3) hv5(8 -inf)");
}

TEST(Shapes, HalfLinesEndAtMinusInfinity) {
  const Profile profile = profile_of({{0, 0}, {1, 1}}, 1);
  EXPECT_EQ(profile.row(0).start.y, down);
  EXPECT_EQ(profile.row(profile.pieces.size() - 1).end.y, down);
  EXPECT_EQ(profile.row(0).start.x, profile.row(0).end.x);
}

TEST(Shapes, NeedlesTouchedAtOnce) {
  // Needles' tips on a circle of radius 5 about the origin: only the outer two have arcs of some length.
  EXPECT_EQ(shape({{-3, -20}, {-3, -4}, {-3, -20}, {0, -20}, {0, -5}, {0, -20}, {3, -20}, {3, -4}, {3, -20}}, 5),
            "hv0(-8 -20) ss0(-8 -4) av1(0 0) av7(8 -4) ss7(8 -20) hv8(8 -inf)");
}

TEST(Shapes, CoordinatesOfUtmSizeLoseNothingButTheirOwnDigits) {
  EXPECT_FALSE(fault_in({{653251.25, 5200000.5}, {653254.5, 5200001}, {653256.25, 5199998.25}}, 1e-3, 1e-9));
}

TEST(Counts, ExplicitVertices) {
  const Terrain valleys{{0, 8}, {6, 0}, {12, 8}, {18, 0}, {24, 8}};
  const Profile profile = profile_of(valleys, 1);
  const ProfileVertexCounts counts = count_profile_vertices(valleys, profile.pieces);
  EXPECT_EQ(counts.all, profile.pieces.size() - 1);
  EXPECT_EQ(counts.explicit_ones, 2u);
}

}  // namespace

}  // namespace krepl::test
