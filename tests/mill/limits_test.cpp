// Passes within a boundary and on shallow ground only: nothing outside, and nothing left between them and waterlines on
// the rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "mill/path_check.hpp"
#include "support/environment.hpp"

namespace krepl::test {
namespace {

/// A dome of radius 6 on level ground, and a ridge: from level to vertical.
std::shared_ptr<const Terrain> hilly(std::size_t n = 121) {
  std::vector<double> heights;
  const double cell = 20.0 / double(n - 1);
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i) {
      const double x = double(i) * cell, y = double(j) * cell;
      const double dome = 25 - (x - 8) * (x - 8) - (y - 9) * (y - 9);
      heights.push_back(std::max({0.0, dome > 0 ? std::sqrt(dome) - 1 : 0, 3 - 1.4 * std::abs(x - 16.5)}));
    }
  auto grid = Terrain::from_grid({n, n, {0, 0}, cell, cell, Terrain::Split::rising}, heights);
  return std::make_shared<const Terrain>(std::move(*grid));
}

/// Places of a ball's centre along cutting moves, in bins of the plane.
class Centres {
 public:
  explicit Centres(double side) : side_(side) {}
  void add(const ToolPath& path, double feed) {
    walk(path, side_ / 20, 1, [&](Point3 p, const Move& m) {
      if (m.kind != MoveKind::rapid && m.feed == feed) bins_[{key(p.x), key(p.y)}].push_back(p);
    });
  }
  /// The least distance from a place.
  double nearest(Point3 c) const {
    double least = 1e300;
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j) {
        const auto bin = bins_.find({key(c.x) + i, key(c.y) + j});
        if (bin == bins_.end()) continue;
        for (const Point3& p : bin->second) least = std::min(least, std::hypot(p.x - c.x, p.y - c.y, p.z - c.z));
      }
    return least;
  }

 private:
  int key(double x) const { return int(std::floor(x / side_)); }
  double side_;
  std::map<std::pair<int, int>, std::vector<Point3>> bins_;
};

TEST(Limits, ShallowPassesAndSteepWaterlinesLeaveNothingBetween) {
  const auto part = hilly();
  const double angle = 45, spacing = 0.4;
  ParallelOptions passes;
  passes.tool.radius = 1, passes.step_over = spacing, passes.shallow = angle, passes.zigzag = false;
  WaterlineOptions waterlines;
  waterlines.tool = passes.tool, waterlines.step_down = spacing, waterlines.steep = angle;
  const auto along = mill_parallel(part, passes);
  const auto around = mill_waterline(part, waterlines);
  ASSERT_TRUE(along && around);
  ParallelOptions whole = passes;
  whole.shallow = 0;
  const auto everywhere = mill_parallel(part, whole);
  ASSERT_TRUE(everywhere);
  EXPECT_LT(along->report.cutting_length, 0.9 * everywhere->report.cutting_length);
  Centres both(1.0), passes_alone(1.0);
  both.add(along->path, passes.motion.feed), both.add(around->path, waterlines.motion.feed);
  passes_alone.add(along->path, passes.motion.feed);
  const auto cutter = DropCutter::build(part, 1.0);
  const Point3 origin = part->origin();
  // Lines on a slope of 45 degrees are sqrt(2) farther apart than in plan or in height.
  const double most = spacing / 2 * std::numbers::sqrt2 + 3 * passes.accuracy.tolerance;
  double worst = 0, worst_alone = 0;
  for (double x = 0.5; x < 19.5; x += 0.0937)
    for (double y = 0.5; y < 19.5; y += 0.0871) {
      const Point3 c{x, y, cutter->at({x - origin.x, y - origin.y}).height + origin.z};
      worst = std::max(worst, both.nearest(c)), worst_alone = std::max(worst_alone, passes_alone.nearest(c));
    }
  EXPECT_LE(worst, most);
  EXPECT_GT(worst_alone, 2 * most) << "there is no steep ground, the test says nothing";
  std::printf("farthest from a cut %g, of passes alone %g\n", worst, worst_alone);
}

/// A square with a hole, and a triangle that overlaps it.
MillBoundary boundary() {
  MillBoundary b;
  b.polygons.push_back(
      {{{3.03, 3.07}, {15.2, 3.07}, {15.2, 14.4}, {3.03, 14.4}}, {{6, 7}, {8, 7}, {8, 9.5}, {6, 9.5}}});
  b.polygons.push_back({{{12, 12}, {19, 13}, {14, 18}}});
  return b;
}

bool is_within(const MillBoundary& b, Point p, double slack) {
  for (const double dx : {-slack, 0.0, slack})
    for (const double dy : {-slack, 0.0, slack}) {
      for (const auto& polygon : b.polygons) {
        bool inside = false;  // winding by angles, not by crossings
        double turns = 0;
        for (const auto& ring : polygon) {
          double turn = 0;
          for (std::size_t k = 0; k < ring.size(); ++k) {
            const Point u{ring[k].x - p.x - dx, ring[k].y - p.y - dy},
                v{ring[(k + 1) % ring.size()].x - p.x - dx, ring[(k + 1) % ring.size()].y - p.y - dy};
            turn += std::atan2(u.x * v.y - u.y * v.x, u.x * v.x + u.y * v.y);
          }
          turns += std::abs(turn) > 1 ? 1 : 0;
        }
        inside = int(turns) % 2 == 1;
        if (inside) return true;
      }
    }
  return false;
}

TEST(Limits, CutsAndLowLinksStayWithinTheBoundary) {
  const auto part = hilly();
  const MillBoundary b = boundary();
  for (const double angle : {0.0, 90.0, 33.0})
    for (const bool zigzag : {true, false}) {
      ParallelOptions o;
      o.tool.radius = 1, o.step_over = 0.3, o.angle = angle, o.zigzag = zigzag, o.boundary = b;
      const auto milled = mill_parallel(part, o);
      ASSERT_TRUE(milled) << milled.error().text();
      double safe = milled->path.start.z;
      std::size_t outside = 0, places = 0;
      double lowest_x = 1e300, highest_y = -1e300;
      walk(milled->path, 0.05, 4, [&](Point3 p, const Move&) {
        if (p.z >= safe - 1e-9) return;
        ++places, outside += !is_within(b, {p.x, p.y}, 1e-9);
        lowest_x = std::min(lowest_x, p.x), highest_y = std::max(highest_y, p.y);
      });
      EXPECT_GT(places, 1000u);
      EXPECT_EQ(outside, 0u) << "angle " << angle;
      // Up to it: passes along x end at the last lattice point before x = 3.03.
      if (angle == 0) {
        EXPECT_LE(lowest_x, 3.03 + 1e-4 + 1e-9);
      }
    }
  WaterlineOptions o;
  o.tool.radius = 1, o.step_down = 0.5, o.boundary = b;
  const auto milled = mill_waterline(part, o);
  ASSERT_TRUE(milled) << milled.error().text();
  std::size_t outside = 0, places = 0;
  walk(milled->path, 0.05, 4, [&](Point3 p, const Move& m) {
    if (m.kind == MoveKind::rapid || m.feed != o.motion.feed) return;
    ++places, outside += !is_within(b, {p.x, p.y}, o.accuracy.tolerance);
  });
  EXPECT_GT(places, 300u);
  EXPECT_EQ(outside, 0u);
}

TEST(Limits, WrongBoundariesAndAnglesAreErrors) {
  const auto part = hilly(11);
  ParallelOptions o;
  o.tool.radius = 1, o.step_over = 0.5;
  o.shallow = 90;
  EXPECT_EQ(mill_parallel(part, o).error().code, ErrorCode::usage);
  o.shallow = 0;
  o.boundary.polygons = {{{{0, 0}, {1, 1}}}};
  EXPECT_EQ(mill_parallel(part, o).error().code, ErrorCode::usage);
  o.boundary.polygons = {{{{100, 100}, {101, 100}, {100, 101}}}};  // nothing is there
  EXPECT_EQ(mill_parallel(part, o).error().code, ErrorCode::input);
}

}  // namespace
}  // namespace krepl::test
