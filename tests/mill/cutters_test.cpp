// Parallel passes of flat, bull-nose, conical and tapered cutters by brute force: never in the part, never farther from it than the
// tolerance.
#include <gtest/gtest.h>

#include <random>

#include "mill/cutter_check.hpp"
#include "support/environment.hpp"
#include "support/small_terrain.hpp"

namespace krepl::test {
namespace {

ParallelOptions options_for(const Cutter& cutter) {
  ParallelOptions o;
  o.tool.cutter = cutter;
  o.accuracy.unit = std::pow(10.0, std::floor(std::log10(cutter.radius() * 1e-3)) - 1);
  o.accuracy.tolerance = 40 * o.accuracy.unit;
  o.step_over = cutter.radius() / 3;
  o.zigzag = false;
  return o;
}

void expect_safe(const SmallTerrain& c, const ParallelOptions& o, const std::string& what) {
  const auto made = terrain_of(c);
  if (!made) return;
  const std::shared_ptr<const Terrain> part = *made;
  const auto milled = mill_parallel(part, o);
  ASSERT_TRUE(milled) << what << ": " << milled.error().text() << "\n" << c;
  const Cutter& cutter = *o.tool.cutter;
  const double scale = std::max(part->extent(), cutter.radius());
  const double floor = o.bottom ? *o.bottom - part->origin().z : part->lowest().z + o.tool.allowance;
  const TipHeights heights(part, cutter, o.tool.allowance, floor);
  const double feed = o.motion.feed, step = std::max(cutter.radius() / 8, scale / 100);
  const TipCheck check =
      check_tip(*part, heights, milled->path, o.accuracy.tolerance + o.accuracy.arc_error, step, 10,
                [feed](const Move& m) { return m.kind != MoveKind::rapid && m.feed == feed; });
  EXPECT_GT(check.places, 20u) << what;
  EXPECT_LE(check.deepest, 1e-9 * scale) << what << " gouges at " << check.deepest_at.x << " " << check.deepest_at.y << " "
                                         << check.deepest_at.z << ", angle " << o.angle << "\n"
                                         << c;
  EXPECT_EQ(check.far, 0u) << what << " is too far above at " << check.far_at.x << " " << check.far_at.y << " "
                           << check.far_at.z << ", angle " << o.angle << "\n"
                           << c;
  const double unit = o.accuracy.unit;
  double worst = 0;
  for (const Move& m : milled->path.moves)
    for (const double x : {m.end.x, m.end.y, m.end.z}) worst = std::max(worst, std::abs(x / unit - std::round(x / unit)));
  EXPECT_LE(worst, 1e-4) << what;
}

TEST(Cutters, NeverCutIntoRandomTerrains) {
  std::mt19937 random(seed());
  const int cases = int(96 * effort());
  for (int k = 0; k < cases; ++k) {
    std::vector<std::uint8_t> bytes(8 + random() % 60);
    for (auto& b : bytes) b = std::uint8_t(random());
    const auto family = SmallTerrainFamily(unsigned(k) % unsigned(SmallTerrainFamily::count));
    const SmallTerrain c = decode_small_terrain(family, bytes);
    ParallelOptions o = options_for(any_cutter(random, c.radius));
    o.angle = std::array{0.0, 90.0, 30.0, -77.3, 180.0, 45.0}[random() % 6];
    if (random() % 4 == 0) o.tool.allowance = c.radius / 5;
    if (random() % 4 == 0) o.accuracy.arc_error = 10 * o.accuracy.unit;
    o.accuracy.tolerance += 2 * o.accuracy.arc_error;
    expect_safe(c, o, std::string(name(family)) + ", case " + std::to_string(k) + ", " + o.tool.cutter->text());
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace krepl::test
