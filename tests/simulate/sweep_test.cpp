// The tool on its way: lowest points and depths against many positions of it, arcs against points on the circle.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulate/path_pieces.hpp"
#include "simulate/swept_tool.hpp"
#include "support/environment.hpp"
#include "terrain/cutter_case.hpp"

namespace krepl::test {

namespace {

using simulate::Piece;
using simulate::SweptTool;

Cutter any_cutter(Random& random) { return random() % 4 == 0 ? *Cutter::ball(2) : any_tool(random, 1).cutter; }

Point3 at(const Piece& p, double t) {
  return {p.from.x + t * (p.to.x - p.from.x), p.from.y + t * (p.to.y - p.from.y), p.from.z + t * (p.to.z - p.from.z)};
}

Piece any_piece(Random& random) {
  Piece piece{{uniform(random, -3, 3), uniform(random, -3, 3), uniform(random, -2, 2)}, {}, 0, false};
  piece.to = {uniform(random, -3, 3), uniform(random, -3, 3), uniform(random, -2, 2)};
  switch (random() % 6) {
    case 0:
      piece.to.x = piece.from.x, piece.to.y = piece.from.y;
      break;  // a plunge
    case 1:
      piece.to.z = piece.from.z;
      break;
    case 2:
      piece.to.y = piece.from.y;
      break;
    case 3:
      piece.to = piece.from;
      break;
    default:
      break;
  }
  return piece;
}

TEST(Sweep, LowestPointsAreThoseOfManyPositions) {
  Random random(seed());
  for (int i = 0; i < 1000; ++i) {
    const Cutter cutter = any_cutter(random);
    const SweptTool tool(cutter);
    const Piece piece = any_piece(random);
    const Point3 centre = at(piece, uniform(random, 0, 1));
    const double angle = uniform(random, 0, 7), r = random() % 5 == 0 ? 1.0 : uniform(random, 0, 1.2);
    const Point place{centre.x + r * std::cos(angle), centre.y + r * std::sin(angle)};
    double least = std::numeric_limits<double>::infinity();
    constexpr int n = 2000;
    for (int k = 0; k <= n; ++k) {
      const Point3 tip = at(piece, double(k) / n);
      const double d = std::hypot(place.x - tip.x, place.y - tip.y);
      if (d < 1 - 1e-12) least = std::min(least, tip.z + cutter.height(d));  // what is at the rim may count or not
    }
    const double lowest = tool.lowest(piece, place);
    ASSERT_LE(lowest, least + 1e-9) << cutter.text() << " case " << i;
    // Between two positions the tool moves by 1/400 at most; flanks and rims multiply that, so nearly is not always
    // near.
    if (std::isinf(least)) continue;
    double nearest =
        std::numeric_limits<double>::infinity();  // the same, of a tool that is wider by what positions miss
    for (int k = 0; k <= n; ++k) {
      const Point3 tip = at(piece, double(k) / n);
      const double d = std::max(0.0, std::hypot(place.x - tip.x, place.y - tip.y) - 0.003);
      nearest = std::min(nearest, tip.z - 0.003 + cutter.height(std::min(d, 1.0)));
    }
    ASSERT_GE(lowest, nearest) << cutter.text() << " case " << i;
  }
}

TEST(Sweep, DepthIsTheLeastWayOut) {
  Random random(seed() + 1);
  for (int i = 0; i < 120; ++i) {
    const Cutter cutter = any_cutter(random);
    const SweptTool tool(cutter);
    const Piece piece = any_piece(random);
    const Point3 tip = at(piece, uniform(random, 0, 1));
    const double r = uniform(random, 0, 1), angle = uniform(random, 0, 7);
    const double up = cutter.height(r) + exponential(random, -2, 0.5);
    const Point3 point{tip.x + r * std::cos(angle), tip.y + r * std::sin(angle), tip.z + up};
    const double depth = tool.depth(piece, point);
    ASSERT_GT(depth, 0) << cutter.text();
    // The way out of one position: to the nearest of many points of its outline.
    double out = 0;
    for (int k = 0; k <= 400; ++k) {
      const Point3 t = at(piece, k / 400.0);
      const double d = std::hypot(point.x - t.x, point.y - t.y), z = point.z - t.z;
      if (d > 1 || z < cutter.height(d)) continue;
      double least = 1 - d;
      for (int j = 0; j <= 400; ++j) least = std::min(least, std::hypot(d - j / 400.0, z - cutter.height(j / 400.0)));
      out = std::max(out, least);
    }
    ASSERT_GE(depth, out - 0.06 * (1 + std::abs(up)))
        << cutter.text() << " case " << i;  // a steep flank's samples are far apart
    ASSERT_LE(depth, out + 0.03) << cutter.text() << " case " << i;
  }
}

TEST(Sweep, DepthsThatAreKnown) {
  const Piece along{{0, 0, 0}, {10, 0, 0}, 0, false};
  EXPECT_NEAR(SweptTool(*Cutter::ball(4)).depth(along, {5, 0, 1.5}), 1.5, 1e-14);
  EXPECT_NEAR(SweptTool(*Cutter::ball(4)).depth(along, {5, 1, 2}), 1, 1e-14);
  EXPECT_NEAR(SweptTool(*Cutter::ball(4)).depth(along, {5, 1.5, 20}), 0.5, 1e-14);  // the shank
  EXPECT_NEAR(SweptTool(*Cutter::flat(4)).depth(along, {5, 0, 0.25}), 0.25, 1e-14);
  EXPECT_NEAR(SweptTool(*Cutter::cone(4, 90)).depth(along, {5, 0, 1}), std::sqrt(0.5), 1e-13);
  EXPECT_NEAR(SweptTool(*Cutter::bull_nose(4, 1)).depth(along, {5, 1.5, 0.5}), 1 - std::sqrt(0.5), 1e-13);
  EXPECT_LE(SweptTool(*Cutter::flat(4)).depth(along, {5, 0, 0}), 0);
  EXPECT_LT(SweptTool(*Cutter::flat(4)).depth(along, {5, 2.5, 3}), 0);
}

TEST(Sweep, ArcsKeepWithinTheirError) {
  Random random(seed() + 2);
  for (int i = 0; i < 300; ++i) {
    const double r = exponential(random, -1, 2), start = uniform(random, 0, 7), turn = uniform(random, 0.01, 6.2);
    const bool left = random() % 2 == 0;
    const double end = start + (left ? turn : -turn), dz = uniform(random, -5, 5);
    const ArcPlane plane = ArcPlane(random() % 3);
    const auto place = [&](double u, double v, double w) {
      return plane == ArcPlane::xy ? Point3{u, v, w} : plane == ArcPlane::zx ? Point3{v, w, u} : Point3{w, u, v};
    };
    ToolPath path;
    path.start = place(3 + r * std::cos(start), -2 + r * std::sin(start), 1);
    Move move{left ? MoveKind::counter_clockwise : MoveKind::clockwise, plane,
              place(3 + r * std::cos(end), -2 + r * std::sin(end), 1 + dz), place(3, -2, 0), 100};
    path.moves.push_back(move);
    EXPECT_NEAR(simulate::length_of(path.start, move), std::hypot(r * turn, dz), 1e-9 * r);
    const double error = r * exponential(random, -6, -1);
    const std::vector<Piece> pieces = simulate::pieces_of(path, {}, 0, error);
    ASSERT_EQ(pieces.front().from, path.start);
    ASSERT_EQ(pieces.back().to, move.end);
    for (int k = 0; k <= 500; ++k) {
      const double f = k / 500.0, angle = start + f * (end - start);
      const Point3 on = place(3 + r * std::cos(angle), -2 + r * std::sin(angle), 1 + f * dz);
      const double which = f * double(pieces.size());
      const std::size_t p = std::min(std::size_t(which), pieces.size() - 1);
      const Point3 chord = at(pieces[p], which - double(p));
      ASSERT_LE(std::hypot(on.x - chord.x, on.y - chord.y, on.z - chord.z), error * (1 + 1e-6) + 1e-12 * r);
    }
  }
}

}  // namespace

}  // namespace krepl::test
