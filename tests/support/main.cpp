// The entry of every test program: one seed for all random generators, printed, never taken from the clock.
#include <cstdio>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "support/environment.hpp"

namespace krepl::test {

std::uint64_t seed() {
  const char* given = std::getenv("KREPL_SEED");
  return given != nullptr && *given != '\0' ? std::strtoull(given, nullptr, 10) : KREPL_DEFAULT_SEED;
}

std::optional<std::filesystem::path> data_directory() {
  const char* given = std::getenv("KREPL_DATA");
  const std::filesystem::path path =
      given != nullptr && *given != '\0' ? std::filesystem::path(given) : source_directory() / ".." / "shared" / "data";
  std::error_code ignored;
  if (!std::filesystem::is_directory(path, ignored)) return std::nullopt;
  return path;
}

std::filesystem::path source_directory() { return KREPL_SOURCE_DIR; }

double effort() {
  const char* given = std::getenv("KREPL_TEST_EFFORT");
  const double value = given != nullptr ? std::atof(given) : 1;
  return value > 0 ? value : 1;
}

}  // namespace krepl::test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  const std::string seed = std::to_string(krepl::test::seed());
  std::printf("seed %s (set KREPL_SEED for another one)\n", seed.c_str());
  std::string rapidcheck = "seed=" + seed + " max_success=" + std::to_string(int(100 * krepl::test::effort()));
  if (const char* given = std::getenv("RC_PARAMS")) rapidcheck += std::string(" ") + given;  // later ones win
  setenv("RC_PARAMS", rapidcheck.c_str(), 1);
  return RUN_ALL_TESTS();
}
