// Cutters other than balls over random terrains of every family: each contact against brute force, and against random
// points of the terrain, none of which may be inside the tool; and the same bits one by one, as a list and as a raster.
#include <gtest/gtest.h>

#include <cmath>

#include "cutter_case.hpp"
#include "support/environment.hpp"

namespace krepl::test {

namespace {

class RandomCutters : public testing::TestWithParam<std::size_t> {};

TEST_P(RandomCutters, AgreeWithBruteForce) {
  const DropFamily& family = drop_families()[GetParam()];
  Random random(seed() + 77 * GetParam());
  const int cases = int(8 * effort());
  for (int i = 0; i < cases; ++i) {
    const DropCase c = family.make(random);
    ASSERT_TRUE(c.terrain);
    const Result<DropCutter> built = DropCutter::build(c.terrain, c.cell);
    ASSERT_TRUE(built.ok()) << built.error().text();
    for (int r = 0; r < 8; ++r) {
      const TestTool tool = any_tool(random, std::min(any_radius(random, c), 8 * c.cell));
      const Result<DropCutter> cutter = built->with_cutter(tool.cutter);
      ASSERT_TRUE(cutter.ok()) << cutter.error().text();
      for (int k = 0; k < 4; ++k) {
        const Point place = any_place(random, c, cutter->radius());
        const DropCutter::Contact contact = cutter->at(place);
        const auto fault = cutter_fault(c, place, tool.cutter, contact);
        ASSERT_FALSE(fault) << c.name << " case " << i << ": " << *fault;
        if (!contact.touches()) continue;
        // Rounding of a sample moves it by u S, which the steepest flank and corner make 2^7 of.
        const double deepest = deepest_sample(c, place, tool.cutter, contact.height, 100, random);
        ASSERT_LE(deepest, 1e-9 * c.scale(cutter->radius()))
            << c.name << " case " << i << " with " << tool.cutter.text();
      }
    }
  }
}

TEST_P(RandomCutters, GiveTheSameBitsInAnyOrder) {
  Random random(seed() + 500 + GetParam());
  for (int i = 0; i < int(4 * effort()); ++i) {
    const DropCase c = drop_families()[GetParam()].make(random);
    const TestTool tool = any_tool(random, std::min(any_radius(random, c), 10 * c.cell));
    const Result<DropCutter> cutter = DropCutter::build(c.terrain, tool.cutter);
    ASSERT_TRUE(cutter.ok());
    const Point3 low = c.terrain->lowest(), high = c.terrain->highest();
    DropCutter::Raster raster{{low.x, low.y}, (high.x - low.x) / 40, (high.y - low.y) / 36, 41, 37};
    if (random() % 2 == 0) raster.step_x = raster.step_y = c.cell / 2;
    std::vector<Point> places;
    for (std::size_t k = 0; k < raster.columns * raster.rows; ++k)
      places.push_back(raster.place(k % raster.columns, k / raster.columns));
    std::vector<DropCutter::Contact> one_by_one, list(places.size()), together(places.size());
    for (const Point place : places) one_by_one.push_back(cutter->at(place));
    Context context;
    context.threads = 2;
    ASSERT_TRUE(cutter->at(raster, together, context).ok());
    ASSERT_EQ(one_by_one, together) << tool.cutter.text();
    std::vector<Point> backwards(places.rbegin(), places.rend());
    ASSERT_TRUE(cutter->at(backwards, list, context).ok());
    std::reverse(list.begin(), list.end());
    ASSERT_EQ(one_by_one, list) << tool.cutter.text();
  }
}

INSTANTIATE_TEST_SUITE_P(Families, RandomCutters, testing::Range<std::size_t>(0, drop_families().size()),
                         [](const auto& info) { return std::string(drop_families()[info.param].name); });

}  // namespace

}  // namespace krepl::test
