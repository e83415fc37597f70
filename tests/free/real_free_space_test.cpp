// Free space on real data. Over terrains against the drop cutter, which finds heights in its own way; among streets
// against all segments.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

#include "krepl/drop_cutter.hpp"
#include "krepl/free_space.hpp"
#include "support/environment.hpp"
#include "support/wkt_file.hpp"

namespace krepl::test {
namespace {

using Random = std::mt19937_64;
double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// An ESRI ASCII grid with cells of side 1 in place of its own.
std::shared_ptr<const Terrain> read_grid(const std::filesystem::path& path) {
  std::istringstream text(read_text(path));
  Terrain::Grid grid;
  std::string name;
  double no_data = NAN;
  for (int i = 0; i < 6; ++i) {
    double value = 0;
    text >> name >> value;
    if (name == "ncols") grid.columns = std::size_t(value);
    if (name == "nrows") grid.rows = std::size_t(value);
    if (name == "NODATA_value") no_data = value;
  }
  std::vector<double> heights(grid.columns * grid.rows);
  for (std::size_t row = grid.rows; row-- > 0;)
    for (std::size_t column = 0; column < grid.columns; ++column) {
      double& z = heights[row * grid.columns + column];
      text >> z;
      if (z == no_data) z = NAN;
    }
  auto terrain = Terrain::from_grid(grid, std::move(heights));
  return terrain ? std::make_shared<const Terrain>(std::move(*terrain)) : nullptr;
}

void check_terrain(const std::shared_ptr<const Terrain>& terrain, double radius, Random& random) {
  const auto cutter = DropCutter::build(terrain, radius);
  const auto space = BallFreeSpace::build(terrain, radius);
  ASSERT_TRUE(cutter.ok() && space.ok());
  const Point3 low = terrain->lowest(), high = terrain->highest(), origin = terrain->origin();
  const double tolerance = 1e-12 * std::max(terrain->extent(), radius);
  int touched = 0, slid = 0;
  for (int i = 0; i < 300; ++i) {
    const Point p{uniform(random, low.x - radius, high.x + radius), uniform(random, low.y - radius, high.y + radius)};
    const auto rest = cutter->at(p);
    const auto at = [&](double z) { return Point3{p.x + origin.x, p.y + origin.y, z + origin.z}; };
    const double top = high.z + 2 * radius;
    const auto down = space->first_contact(at(top), at(low.z - 2 * radius));
    ASSERT_EQ(bool(down), rest.touches());
    if (!rest.touches()) continue;
    ++touched;
    // What rests touches, nothing more and nothing less.
    ASSERT_NEAR(space->clearance(at(rest.height)).clearance, 0, tolerance);
    ASSERT_LT(space->clearance(at(rest.height - 0.01 * radius)).clearance, 0);
    ASSERT_GT(space->clearance(at(rest.height + 0.01 * radius)).clearance, 0);
    ASSERT_LE(space->clearance(at(rest.height + 0.01 * radius)).clearance, 0.01 * radius + tolerance);
    // On the rim of the ball heights amplify the tolerance.
    const Point3 landed = down->place;
    ASSERT_NEAR(space->clearance(landed).clearance, 0, tolerance);
    if (std::hypot(rest.point.x - p.x, rest.point.y - p.y) < 0.99 * radius) {
      ASSERT_NEAR(landed.z, rest.height + origin.z, 100 * tolerance);
    }
    // A level motion is free as far as no ball that rests in its way is higher.
    const Point q{p.x + uniform(random, -4, 4) * radius, p.y + uniform(random, -4, 4) * radius};
    const double level = rest.height + uniform(random, 0, radius);
    const Point3 goal{q.x + origin.x, q.y + origin.y, level + origin.z};
    const auto cut = space->first_contact(at(level), goal);
    const double until = cut ? cut->t : 1;
    for (int k = 0; k <= 40; ++k) {
      const Point on{p.x + k * until / 40 * (q.x - p.x), p.y + k * until / 40 * (q.y - p.y)};
      ASSERT_LE(cutter->at(on).height, level + 1e-7 * terrain->extent()) << "walls amplify what t is off by";
    }
    slid += bool(cut);
  }
  EXPECT_GT(touched, 200);
  EXPECT_GT(slid, 20);
}

TEST(RealFreeSpace, Terrains) {
  const auto data = data_directory();
  if (!data) GTEST_SKIP() << "no real data: set KREPL_DATA to a directory with dem/volcano.asc";
  Random random(seed());
  for (const char* file : {"volcano.asc", "jacksboro.asc.gz"}) {
    const auto terrain = read_grid(*data / "dem" / file);
    ASSERT_TRUE(terrain) << file;
    for (const double radius : {0.7, 5.0, 30.0}) {
      SCOPED_TRACE(testing::Message() << file << " R " << radius);
      check_terrain(terrain, radius, random);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(RealFreeSpace, Streets) {
  const auto data = data_directory();
  if (!data) GTEST_SKIP() << "no real data: set KREPL_DATA to a directory with vector/roads_monaco_e7.wkt.gz";
  const ZoneCase c{read_wkt_file(*data / "vector/roads_monaco_e7.wkt.gz"), 0};
  auto made = network_of(c);
  ASSERT_TRUE(made.ok());
  const auto network = std::make_shared<const Network>(std::move(*made));
  const double size = network->extent();
  const auto space = DiskFreeSpace::build(network, 1e-3 * size);
  ASSERT_TRUE(space.ok());
  Random random(seed());
  int free = 0;
  for (int i = 0; i < 300; ++i) {
    const Point p{uniform(random, -size, size), uniform(random, -size, size)};
    long double nearest = HUGE_VALL;
    for (const Network::Segment& s : network->segments()) {
      const Point a = network->vertices()[s.a], b = network->vertices()[s.b];
      const long double dx = b.x - a.x, dy = b.y - a.y, px = p.x - a.x, py = p.y - a.y;
      const long double t = std::clamp<long double>((px * dx + py * dy) / (dx * dx + dy * dy), 0, 1);
      nearest = std::min(nearest, std::hypot(px - t * dx, py - t * dy));
    }
    const Point place{p.x + network->origin().x, p.y + network->origin().y};
    const auto contact = space->clearance(place);
    free += contact.free();
    // Adding the origin rounds the placement.
    ASSERT_NEAR(contact.clearance, double(nearest - space->radius()), 1e-12 * size + network->resolution());
  }
  EXPECT_GT(free, 100);
  EXPECT_LT(free, 300);
}

}  // namespace
}  // namespace krepl::test
