// The fuzz target's check on random small terrains, kind by kind; a case that fails is made smaller before it is shown.
#include <cstdio>
#include <random>

#include <gtest/gtest.h>

#include "fuzz/surface_fuzz.hpp"
#include "support/environment.hpp"

namespace krepl::test {
namespace {

using FuzzSurface = testing::TestWithParam<int>;

TEST_P(FuzzSurface, EveryCaseIsSound) {
  const SmallTerrainFamily family = SmallTerrainFamily(GetParam());
  std::mt19937_64 random(seed() + std::uint64_t(GetParam()));
  const int cases = int(500 * effort());
  int failures = 0;
  for (int i = 0; i < cases; ++i) {
    std::vector<std::uint8_t> bytes(4 + random() % 45);
    for (auto& b : bytes) b = std::uint8_t(random());
    if (!fuzz_surface(family, bytes)) continue;
    const SmallTerrain small = minimised(decode_small_terrain(family, bytes));
    const auto fault = fault_in(small);
    ADD_FAILURE() << "case " << i << ": " << fault.value_or("only before it was made smaller") << '\n' << text(small);
    ASSERT_LT(++failures, 10) << "giving up";
  }
  std::printf("%d cases\n", cases);
}

INSTANTIATE_TEST_SUITE_P(Families, FuzzSurface, testing::Range(0, int(SmallTerrainFamily::count)),
                         [](const auto& info) { return name(SmallTerrainFamily(info.param)); });

}  // namespace
}  // namespace krepl::test
