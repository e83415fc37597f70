// Parallel passes by brute force: never in the part, never farther from it than the tolerance, arcs as controllers run them.
#include <gtest/gtest.h>

#include <random>

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

/// Moves that a tolerance holds for: not those between cuts, which stay above. They are the ones that start or end on none of the
/// passes; here: rapid moves, and moves at the plunge feed.
void expect_safe(const SmallTerrain& c, const ParallelOptions& o, const char* what) {
  const auto made = terrain_of(c);
  if (!made) return;
  const std::shared_ptr<const Terrain> part = *made;
  const auto milled = mill_parallel(part, o);
  ASSERT_TRUE(milled) << what << ": " << milled.error().text() << "\n" << c;
  const double grown = o.tool.radius + o.tool.allowance, scale = std::max(part->extent(), o.tool.radius);
  const double floor = o.bottom ? *o.bottom + o.tool.radius - part->origin().z : part->lowest().z + grown;
  const double step = std::max(o.tool.radius / 8, scale / 100);
  const PathCheck check = check_path(*part, part, milled->path, grown, grown + o.accuracy.tolerance + o.accuracy.arc_error, floor,
                                     step, 10, [](const Move&) { return false; });
  EXPECT_LE(check.deepest, 1e-9 * scale) << what << " gouges at " << check.deepest_at.x << " " << check.deepest_at.y << " "
                                         << check.deepest_at.z << ", angle " << o.angle << "\n" << c;
  EXPECT_LE(worst_rounding(milled->path, o.accuracy.unit, o.accuracy.control_point == ControlPoint::tip ? o.tool.radius : 0), 1e-4) << what;
  // One way without links in between: what is cut along passes stays within the tolerance.
  ParallelOptions one_way = o;
  one_way.zigzag = false;
  const auto passes = mill_parallel(part, one_way);
  ASSERT_TRUE(passes);
  const double feed = one_way.motion.feed;
  const PathCheck near = check_path(*part, part, passes->path, grown, grown + o.accuracy.tolerance + o.accuracy.arc_error, floor,
                                    step, 10, [feed](const Move& m) { return m.kind != MoveKind::rapid && m.feed == feed; });
  EXPECT_LE(near.deepest, 1e-9 * scale) << what;
  EXPECT_LE(near.highest, 1e-9 * scale) << what << " is too far above at " << near.highest_at.x << " " << near.highest_at.y << " "
                                        << near.highest_at.z << ", angle " << o.angle << "\n" << c;
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

}  // namespace
}  // namespace krepl::test
