// Parallel passes by brute force: never in the part, never farther from it than the tolerance, arcs as controllers run
// them.
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "krepl/drop_cutter.hpp"
#include "mill/ball_bodies.hpp"
#include "mill/drive_curve.hpp"
#include "mill/path_check.hpp"
#include "support/environment.hpp"
#include "support/small_terrain.hpp"

namespace krepl::test {
namespace {

ParallelOptions options_for(double radius) {
  ParallelOptions o;
  o.tool.radius = radius;
  o.accuracy.unit = std::pow(10.0, std::floor(std::log10(radius * 1e-3)) - 1);
  o.accuracy.tolerance = 40 * o.accuracy.unit;
  o.step_over = radius / 3;
  return o;
}

/// Every number of the path is a multiple of the unit, as the post writes it.
double worst_rounding(const ToolPath& path, double unit, double tip) {
  double worst = 0;
  const auto look = [&](double x) { worst = std::max(worst, std::abs(x / unit - std::round(x / unit))); };
  for (const Move& m : path.moves) look(m.end.x), look(m.end.y), look(m.end.z - tip);
  return worst;
}

/// Moves that a tolerance holds for: not those between cuts, which stay above. They are the ones that start or end on
/// none of the passes; here: rapid moves, and moves at the plunge feed.
void expect_safe(const SmallTerrain& c, const ParallelOptions& o, const char* what) {
  const auto made = terrain_of(c);
  if (!made) return;
  const std::shared_ptr<const Terrain> part = *made;
  const auto milled = mill_parallel(part, o);
  ASSERT_TRUE(milled) << what << ": " << milled.error().text() << "\n" << c;
  const double grown = o.tool.radius + o.tool.allowance, scale = std::max(part->extent(), o.tool.radius);
  const double floor = o.bottom ? *o.bottom + o.tool.radius - part->origin().z : part->lowest().z + grown;
  const double step = std::max(o.tool.radius / 8, scale / 100);
  const PathCheck check =
      check_path(*part, part, milled->path, grown, grown + o.accuracy.tolerance + o.accuracy.arc_error, floor, step, 10,
                 [](const Move&) { return false; });
  EXPECT_LE(check.deepest, 1e-9 * scale) << what << " gouges at " << check.deepest_at.x << " " << check.deepest_at.y
                                         << " " << check.deepest_at.z << ", angle " << o.angle << "\n"
                                         << c;
  EXPECT_LE(
      worst_rounding(milled->path, o.accuracy.unit, o.accuracy.control_point == ControlPoint::tip ? o.tool.radius : 0),
      1e-4)
      << what;
  // One way without links in between: what is cut along passes stays within the tolerance.
  ParallelOptions one_way = o;
  one_way.zigzag = false;
  const auto passes = mill_parallel(part, one_way);
  ASSERT_TRUE(passes);
  const double feed = one_way.motion.feed;
  const PathCheck near =
      check_path(*part, part, passes->path, grown, grown + o.accuracy.tolerance + o.accuracy.arc_error, floor, step, 10,
                 [feed](const Move& m) { return m.kind != MoveKind::rapid && m.feed == feed; });
  EXPECT_LE(near.deepest, 1e-9 * scale) << what;
  EXPECT_LE(near.highest, 1e-9 * scale) << what << " is too far above at " << near.highest_at.x << " "
                                        << near.highest_at.y << " " << near.highest_at.z << ", angle " << o.angle
                                        << "\n"
                                        << c;
}

TEST(ParallelPasses, NeverCutIntoRandomTerrains) {
  std::mt19937 random(seed());
  const int cases = int(48 * effort());
  for (int k = 0; k < cases; ++k) {
    std::vector<std::uint8_t> bytes(8 + random() % 60);
    for (auto& b : bytes) b = std::uint8_t(random());
    const auto family = SmallTerrainFamily(unsigned(k) % unsigned(SmallTerrainFamily::count));
    const SmallTerrain c = decode_small_terrain(family, bytes);
    ParallelOptions o = options_for(c.radius);
    o.angle = std::array{0.0, 90.0, 30.0, -77.3, 180.0, 45.0}[random() % 6];
    if (random() % 4 == 0) o.tool.allowance = c.radius / 5;
    if (random() % 4 == 0) o.accuracy.control_point = ControlPoint::centre;
    if (random() % 4 == 0) o.accuracy.arc_error = 10 * o.accuracy.unit;
    o.accuracy.tolerance += 2 * o.accuracy.arc_error;
    expect_safe(c, o, name(family));
    if (HasFailure()) return;
  }
}

/// The part's surface after milling, by brute force: at places of a fine raster, how far above the ball at rest the
/// nearest ball of the path is along the normal of the point touched.
class Scallop {
 public:
  Scallop(const ToolPath& path, double feed, double radius) : radius_(radius) {
    walk(path, radius / 40, 1, [&](Point3 p, const Move& m) {
      if (m.kind != MoveKind::rapid && m.feed == feed) bins_[key(p.x, p.y)].push_back(p);
    });
  }
  /// What is left above a touched point q along n.
  double left(Point3 q, Point3 n) const {
    double least = 1e300;
    const Point3 c{q.x + radius_ * n.x, q.y + radius_ * n.y, q.z + radius_ * n.z};
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j) {
        const auto bin = bins_.find(key(c.x + i * size(), c.y + j * size()));
        if (bin == bins_.end()) continue;
        for (const Point3& a : bin->second) {
          const Point3 d{a.x - q.x, a.y - q.y, a.z - q.z};
          const double along = d.x * n.x + d.y * n.y + d.z * n.z;
          const double under = radius_ * radius_ - (d.x * d.x + d.y * d.y + d.z * d.z - along * along);
          if (under >= 0) least = std::min(least, along - std::sqrt(under));
        }
      }
    return least;
  }

 private:
  double size() const { return radius_ / 2; }
  std::pair<int, int> key(double x, double y) const {
    return {int(std::floor(x / size())), int(std::floor(y / size()))};
  }
  double radius_;
  std::map<std::pair<int, int>, std::vector<Point3>> bins_;
};

TEST(ParallelPasses, LeaveNoMoreThanTheScallopOnSlopesAndDomes) {
  // A roof that rises across the passes by 45 degrees and more, a dome and a bowl, as a fine grid.
  const std::size_t n = 161;
  const double cell = 0.125;
  std::vector<double> heights;
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i) {
      const double x = double(i) * cell - 10, y = double(j) * cell - 10;
      const double dome = 36 - (x - 4) * (x - 4) - (y + 4) * (y + 4), bowl = (x + 4) * (x + 4) + (y + 4) * (y + 4);
      double z = y > 2 ? 8 - 1.2 * std::abs(y - 6) : 1;
      if (dome > 0) z = std::max(z, std::sqrt(dome) - 2);
      if (bowl < 16) z = 1 + 6 - std::sqrt(52 - bowl);
      heights.push_back(z);
    }
  auto grid = Terrain::from_grid({n, n, {0, 0}, cell, cell, Terrain::Split::rising}, heights);
  ASSERT_TRUE(grid);
  const auto part = std::make_shared<const Terrain>(std::move(*grid));
  for (const double angle : {0.0, 90.0}) {
    ParallelOptions o;
    o.tool.radius = 1.5, o.scallop = 0.04, o.angle = angle, o.zigzag = false;
    const auto milled = mill_parallel(part, o);
    ASSERT_TRUE(milled) << milled.error().text();
    EXPECT_GT(milled->report.extra_passes, 0u);
    const auto cutter = DropCutter::build(part, o.tool.radius);
    const Scallop scallop(milled->path, o.motion.feed, o.tool.radius);
    std::size_t places = 0, over = 0;
    const Point3 origin = part->origin();
    double worst = 0;
    for (double x = 1; x < 19; x += 0.0973)
      for (double y = 1; y < 19; y += 0.0717) {
        const auto contact = cutter->at({x - origin.x, y - origin.y});
        const Point3 q{contact.point.x + origin.x, contact.point.y + origin.y, contact.point.z + origin.z};
        const Point3 normal{(x - q.x) / 1.5, (y - q.y) / 1.5, (contact.height + origin.z - q.z) / 1.5};
        const double left = scallop.left(q, normal);
        ++places, over += left > o.scallop;
        worst = std::max(worst, left);
      }
    EXPECT_EQ(milled->report.open_places, 0u) << "angle " << angle;
    EXPECT_EQ(over, 0u) << "angle " << angle << ", worst " << worst << ", of " << places;
    EXPECT_GT(worst, 0.7 * o.scallop);
    std::printf("angle %g: %zu of %zu places over the scallop, worst %g\n", angle, over, places, worst);
  }
}

// The ball just touches the edge of a roof all along: the normal there is level.
TEST(DriveCurves, StayBetweenFloorAndEdgeAlongAWallAtExactlyTheRadius) {
  for (const double rise : {0.0, 0.25}) {
    auto roof = Terrain::from_triangles({{0, 0, 1}, {1, 0, 1}, {1, 1, 1 + rise}, {0, 1, 1 + rise}}, {{0, 1, 2}, {0, 2, 3}});
    ASSERT_TRUE(roof);
    const auto part = std::make_shared<const Terrain>(std::move(*roof));
    const auto cutter = DropCutter::build(part, 0.5);
    ASSERT_TRUE(cutter);
    const Point3 origin = part->origin();
    constexpr double floor = -1;
    for (const double side : {-0.5, 1.5}) {
      for (const double direction : {1.0, -1.0}) {
        mill::BallBodies bodies(*cutter);
        mill::DriveCurve curve(bodies, {floor, 1e-3, 1e-7, 1e-3});
        std::vector<mill::CurveRun> runs;
        const mill::Line line{{side - origin.x, (direction > 0 ? -1 : 2) - origin.y}, {0, direction}};
        curve.trace(line, 0, 3, true, runs);
        ASSERT_EQ(runs.size(), 1u);
        for (const mill::CurvePoint& p : runs.front()) {
          EXPECT_TRUE(p.z >= floor && p.z <= 1 + rise - origin.z + 1e-3) << p.z << " at " << p.t << ", rise " << rise;
        }
      }
    }
  }
}

}  // namespace
}  // namespace krepl::test
