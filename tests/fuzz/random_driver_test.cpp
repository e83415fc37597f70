// The fuzz target's check on random bytes, without a fuzzer: for compilers that have none, and for every run.
#include <cstdio>
#include <random>

#include <gtest/gtest.h>

#include "fuzz/zone_fuzz.hpp"
#include "support/environment.hpp"

namespace krepl::test {
namespace {

TEST(FuzzRandom, EveryCaseIsSound) {
  std::mt19937_64 random(seed());
  const int cases = int(3000 * effort());
  int failures = 0;
  for (int i = 0; i < cases; ++i) {
    std::vector<std::uint8_t> bytes(2 + random() % (i % 10 == 0 ? 160 : 40));
    for (auto& b : bytes) b = std::uint8_t(random());
    const auto fault = fuzz_zone(bytes);
    EXPECT_FALSE(fault.has_value()) << "case " << i << ": " << *fault;
    ASSERT_LT(failures += fault.has_value(), 50) << "giving up";
  }
  std::printf("%d cases\n", cases);
}

TEST(FuzzRandom, EnginesAgree) {
  std::mt19937_64 random(seed() + 1);
  const int cases = int(800 * effort());
  for (int i = 0; i < cases; ++i) {
    std::vector<std::uint8_t> bytes(2 + random() % 60);
    for (auto& b : bytes) b = std::uint8_t(random());
    const auto fault = fuzz_engines(bytes);
    ASSERT_FALSE(fault.has_value()) << "case " << i << ": " << *fault;
  }
}

}  // namespace
}  // namespace krepl::test
