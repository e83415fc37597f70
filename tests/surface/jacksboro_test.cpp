// Places of a real elevation model at which engines went wrong (spots in cells from its first row and column, radii in
// cells).
#include <gtest/gtest.h>

#include <cmath>

#include "input/terrain_reader.hpp"
#include "support/environment.hpp"
#include "support/surface_faults.hpp"

namespace krepl::test {
namespace {

constexpr double cell = 92;

struct Spot {
  const char* name;
  double column, row, radius;
};
const Spot spots[] = {
    {"SliverFace", 88.056, 108.970, 10},
    {"FourPlanesAtAPoint", 346.99, 71.15, 1},
    {"TwoRootsOfOneTriple", 225.63, 155.70, 10},
    {"BeyondARoundedCell", 300, 123, 30},
};

class JacksboroSpot : public testing::TestWithParam<Spot> {
 protected:
  void SetUp() override {
    const auto data = data_directory();
    if (!data) GTEST_SKIP() << "no real data: set KREPL_DATA to a directory with dem/jacksboro.asc.gz";
    input::TerrainRequest request;
    request.path = (*data / "dem/jacksboro.asc.gz").string();
    const auto file = input::read_terrain(request);
    ASSERT_TRUE(file.ok()) << file.error().text();
    terrain_ = file->terrain;
  }

  /// All samples that a ball over the spot can reach, with cells of equal sides; rows from the first or from the last
  /// one.
  SmallTerrain window(const Spot& spot, bool from_first) const {
    const auto& whole = terrain_->grid();
    const auto range = [&](double middle, std::size_t count) {
      const double reach = spot.radius + 3;
      return std::pair(std::size_t(std::max(0.0, std::floor(middle - reach))),
                       std::min(count - 1, std::size_t(std::ceil(middle + reach))));
    };
    const auto [c0, c1] = range(spot.column, whole.columns);
    const auto [r0, r1] = range(spot.row, whole.rows);
    SmallTerrain c;
    c.grid.columns = c1 - c0 + 1, c.grid.rows = r1 - r0 + 1;
    c.grid.first = {cell * double(c0), cell * double(r0)};
    c.grid.cell_x = c.grid.cell_y = cell;
    c.radius = cell * spot.radius;
    for (std::size_t r = r0; r <= r1; ++r) {
      for (std::size_t k = c0; k <= c1; ++k) {
        // The first row of the file is the one with the largest y.
        const std::size_t row = from_first ? whole.rows - 1 - r : r;
        c.heights.push_back(terrain_->corners(Terrain::Index(6 * (row * whole.columns + k))).point[0].z +
                            terrain_->origin().z);
      }
    }
    return c;
  }

  std::shared_ptr<const Terrain> terrain_;
};

TEST_P(JacksboroSpot, IsSound) {
  for (const bool from_first : {true, false}) {
    const SmallTerrain c = window(GetParam(), from_first);
    const auto fault = fault_in(c, {.points = 4, .lines = 10, .seconds = 120});
    EXPECT_FALSE(fault) << *fault << (from_first ? " (rows from the first)" : " (rows from the last)");
  }
}

INSTANTIATE_TEST_SUITE_P(Spots, JacksboroSpot, testing::ValuesIn(spots),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace krepl::test
