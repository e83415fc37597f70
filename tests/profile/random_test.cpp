// Thousands of small random terrains of every family against brute force, and against the other two ways to run.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "support/environment.hpp"
#include "terrain_case.hpp"

namespace krepl::test {

namespace {

class RandomProfiles : public testing::TestWithParam<std::size_t> {};

std::size_t some_points(std::mt19937_64& random) {
  return std::size_t(std::pow(2, std::uniform_real_distribution<double>(0.6, 7)(random)));
}

TEST_P(RandomProfiles, AgreeWithBruteForce) {
  const Family& family = families()[GetParam()];
  std::mt19937_64 random(seed() + GetParam());
  const int cases = int(400 * effort());
  for (int i = 0; i < cases; ++i) {
    const Terrain terrain = family.make(random, some_points(random));
    const double radius = any_radius(random, terrain);
    const auto fault = fault_in(terrain, radius);
    ASSERT_FALSE(fault) << family.name << " case " << i << ": " << *fault << "\n" << text(terrain, radius);
  }
}

TEST_P(RandomProfiles, AreTheSameBitsInBlocksAndAsStream) {
  const Family& family = families()[GetParam()];
  std::mt19937_64 random(seed() + 1000 + GetParam());
  const int cases = int(400 * effort());
  const std::array<std::size_t, 7> sizes{1, 2, 3, 5, 8, 21, 64};
  for (int i = 0; i < cases; ++i) {
    const Terrain terrain = family.make(random, some_points(random));
    const double radius = any_radius(random, terrain);
    const auto difference = difference_in(terrain, radius, sizes);
    ASSERT_FALSE(difference) << family.name << " case " << i << ": " << *difference << "\n" << text(terrain, radius);
  }
}

INSTANTIATE_TEST_SUITE_P(Families, RandomProfiles, testing::Range<std::size_t>(0, families().size()),
                         [](const auto& info) {
                           std::string name = families()[info.param].name;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

}  // namespace

}  // namespace krepl::test
