// Errors and promises of the header.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "drop_terrains.hpp"

namespace krepl::test {

namespace {

DropCase some_case() {
  Random random(5);
  return drop_families()[0].make(random);
}

void expect_error(const Result<DropCutter>& result, const std::string& part) {
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, ErrorCode::usage);
  EXPECT_NE(result.error().text().find(part), std::string::npos) << result.error().text();
}

TEST(DropInterface, RadiiThatAreNone) {
  const DropCase c = some_case();
  for (const double radius : {0.0, -1.0, double(NAN), double(INFINITY)}) {
    expect_error(DropCutter::build(c.terrain, radius), "not a finite number greater than zero");
  }
  expect_error(DropCutter::build(c.terrain, c.terrain->extent() * 0x1p-51), "too small");
  expect_error(DropCutter::build(c.terrain, c.terrain->extent() * 0x1p51), "too large");
  const Result<DropCutter> cutter = DropCutter::build(c.terrain, 1);
  ASSERT_TRUE(cutter.ok());
  expect_error(cutter->with_radius(-3), "not a finite number");
}

TEST(DropInterface, CoordinatesOutOfRange) {
  Terrain::Grid grid;
  grid.columns = grid.rows = 2, grid.cell_x = grid.cell_y = 1e40;
  const DropCase c = grid_case("huge", grid, {0, 0, 0, 1e40});
  const Result<DropCutter> cutter = DropCutter::build(c.terrain, 1e40);
  ASSERT_FALSE(cutter.ok());
  EXPECT_EQ(cutter.error().code, ErrorCode::input);
}

TEST(DropInterface, CoordinatesNearTheEndsOfTheRange) {
  for (const double unit : {1e-15, 1e-9, 1e9, 1e25}) {
    Random random(11);
    Terrain::Grid grid;
    grid.columns = grid.rows = 12, grid.cell_x = grid.cell_y = unit;
    std::vector<double> z;
    for (int i = 0; i < 144; ++i) z.push_back(unit * uniform(random, 0, 2));
    const DropCase c = grid_case("scaled", grid, z);
    const Result<DropCutter> cutter = DropCutter::build(c.terrain, 2 * unit);
    ASSERT_TRUE(cutter.ok());
    for (int k = 0; k < 50; ++k) {
      const Point place = any_place(random, c, 2 * unit);
      const auto fault = fault_of(c, place, 2 * unit, cutter->at(place));
      EXPECT_FALSE(fault) << *fault;
    }
  }
}

TEST(DropInterface, AnotherRadiusIsTheSameAsANewCutter) {
  const DropCase c = some_case();
  const Result<DropCutter> one = DropCutter::build(c.terrain, 1);
  ASSERT_TRUE(one.ok());
  const Result<DropCutter> two = one->with_radius(3), fresh = DropCutter::build(c.terrain, 3);
  ASSERT_TRUE(two.ok() && fresh.ok());
  EXPECT_EQ(two->radius(), 3);
  EXPECT_EQ(&two->terrain(), c.terrain.get());
  Random random(6);
  for (int k = 0; k < 100; ++k) {
    const Point place = any_place(random, c, 3);
    EXPECT_EQ(two->at(place), fresh->at(place));
  }
}

TEST(DropInterface, OutlivesItsMaker) {
  Result<DropCutter> kept = [] {
    const DropCase c = some_case();
    return DropCutter::build(c.terrain, 2)->with_radius(4);
  }();
  ASSERT_TRUE(kept.ok());
  const Point3 low = kept->terrain().lowest();
  EXPECT_TRUE(kept->at({low.x, low.y}).touches());
}

TEST(DropInterface, SizesMustAgree) {
  const DropCase c = some_case();
  const Result<DropCutter> cutter = DropCutter::build(c.terrain, 1);
  ASSERT_TRUE(cutter.ok());
  std::vector<Point> places(3);
  std::vector<DropCutter::Contact> contacts(4);
  EXPECT_FALSE(cutter->at(places, contacts).ok());
  DropCutter::Raster raster;
  raster.columns = 3, raster.rows = 1;
  EXPECT_FALSE(cutter->at(raster, contacts).ok());
  raster.columns = raster.rows = std::size_t{1} << 33;  // the product is zero in 64 bits
  EXPECT_FALSE(cutter->at(raster, std::span<DropCutter::Contact>{}).ok());
  raster.columns = raster.rows = 2;
  EXPECT_TRUE(cutter->at(raster, contacts).ok());
}

TEST(DropInterface, NoPlacesAreFine) {
  const DropCase c = some_case();
  const Result<DropCutter> cutter = DropCutter::build(c.terrain, 1);
  ASSERT_TRUE(cutter.ok());
  EXPECT_TRUE(cutter->at(std::span<const Point>{}, {}).ok());
  EXPECT_TRUE(cutter->at(DropCutter::Raster{}, {}).ok());
  DropCutter::Raster raster;
  raster.rows = 7;
  EXPECT_TRUE(cutter->at(raster, {}).ok());
}

TEST(DropInterface, CancelAndProgress) {
  const DropCase c = some_case();
  std::atomic<bool> stop{true};
  Context context;
  context.cancel = &stop;
  EXPECT_EQ(DropCutter::build(c.terrain, 1, context).error().code, ErrorCode::cancelled);
  const Result<DropCutter> cutter = DropCutter::build(c.terrain, 1);
  ASSERT_TRUE(cutter.ok());
  std::vector<Point> places(5000);
  std::vector<DropCutter::Contact> contacts(5000);
  EXPECT_EQ(cutter->at(places, contacts, context).error().code, ErrorCode::cancelled);
  stop = false;
  double last = 0;
  context.progress = [&](double done) { last = std::max(last, done); };
  EXPECT_TRUE(cutter->at(places, contacts, context).ok());
  EXPECT_EQ(last, 1);
}

}  // namespace

}  // namespace krepl::test
