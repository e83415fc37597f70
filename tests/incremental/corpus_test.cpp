// Small degenerate terrains by both engines.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "support/surface_faults.hpp"

namespace krepl::test {
namespace {

std::vector<std::string> blocks_of(const std::string& name) {
  std::ifstream file(KREPL_SOURCE_DIR "/tests/corpus/surface/" + name);
  std::vector<std::string> blocks;
  std::string line, block;
  while (true) {
    const bool more = bool(std::getline(file, line));
    if (more && !line.empty() && line[0] == '#') continue;
    if (more && !line.empty()) {
      block += line + "\n";
      continue;
    }
    if (!block.empty()) blocks.push_back(block);
    block.clear();
    if (!more) return blocks;
  }
}

std::optional<std::string> fault_of(const std::string& block) {
  const std::optional<SmallTerrain> terrain = parse_small_terrain(block);
  if (!terrain) return "cannot be read";
  const auto surface = surface_within(*terrain, 60);
  return surface ? fault_between_engines(*surface, *terrain) : surface.error().text();
}

TEST(IncrementalCorpus, BothEnginesAgree) {
  const std::vector<std::string> open = blocks_of("engines_differ.txt"), blocks = blocks_of("minimised.txt");
  ASSERT_GE(blocks.size(), 133u);
  for (const std::string& block : blocks) {
    if (std::find(open.begin(), open.end(), block) != open.end()) continue;
    const auto fault = fault_of(block);
    EXPECT_FALSE(fault) << *fault << "\n" << block;
  }
}

TEST(IncrementalCorpus, WhereTheyDifferTheyStillDo) {
  for (const std::string& block : blocks_of("engines_differ.txt")) {
    EXPECT_TRUE(fault_of(block)) << "equal now, and to be taken out of engines_differ.txt:\n" << block;
  }
}

}  // namespace
}  // namespace krepl::test
