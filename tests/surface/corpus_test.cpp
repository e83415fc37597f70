#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "support/surface_faults.hpp"

// Small degenerate terrains that the engine once got wrong or could not finish.
namespace krepl::test {
namespace {

std::vector<std::string> blocks_of(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> blocks;
  std::string line, block;
  const auto close = [&] {
    if (!block.empty()) blocks.push_back(block);
    block.clear();
  };
  while (std::getline(file, line)) {
    if (line.empty()) close();
    else if (line[0] != '#') block += line + "\n";
  }
  close();
  return blocks;
}

TEST(SurfaceCorpus, MinimisedTerrainsAreRight) {
  const std::vector<std::string> blocks = blocks_of(KREPL_SOURCE_DIR "/tests/corpus/surface/minimised.txt");
  ASSERT_GE(blocks.size(), 140u);
  for (const std::string& block : blocks) {
    const std::optional<SmallTerrain> terrain = parse_small_terrain(block);
    ASSERT_TRUE(terrain) << block;
    const auto fault = fault_in(*terrain, {.seconds = 60});
    EXPECT_FALSE(fault) << *fault << "\n" << block;
  }
}

}  // namespace
}  // namespace krepl::test
