// Random terrains of every family, radii from 0.01 to 100 cells, places everywhere: each contact against brute force.
#include <gtest/gtest.h>

#include "drop_terrains.hpp"
#include "support/environment.hpp"

namespace krepl::test {

namespace {

class RandomDrops : public testing::TestWithParam<std::size_t> {};

TEST_P(RandomDrops, AgreeWithBruteForce) {
  const DropFamily& family = drop_families()[GetParam()];
  Random random(seed() + GetParam());
  const int cases = int(25 * effort());
  for (int i = 0; i < cases; ++i) {
    const DropCase c = family.make(random);
    ASSERT_TRUE(c.terrain);
    const Result<DropCutter> built = DropCutter::build(c.terrain, c.cell);
    ASSERT_TRUE(built.ok()) << built.error().text();
    for (int r = 0; r < 4; ++r) {
      const Result<DropCutter> cutter = built->with_radius(any_radius(random, c));
      ASSERT_TRUE(cutter.ok());
      for (int k = 0; k < 12; ++k) {
        const Point place = any_place(random, c, cutter->radius());
        const auto fault = fault_of(c, place, cutter->radius(), cutter->at(place));
        ASSERT_FALSE(fault) << c.name << " case " << i << ": " << *fault;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Families, RandomDrops, testing::Range<std::size_t>(0, drop_families().size()),
                         [](const auto& info) { return std::string(drop_families()[info.param].name); });

}  // namespace

}  // namespace krepl::test
