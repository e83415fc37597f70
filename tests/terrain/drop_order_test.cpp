// One place, a list of places and a raster give the same bits, in any order and on any number of threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "drop_terrains.hpp"
#include "support/environment.hpp"

namespace krepl::test {

namespace {

using Contact = DropCutter::Contact;

class DropOrder : public testing::TestWithParam<std::size_t> {
 protected:
  /// Calls check(cutter, case, random) for some random terrains and radii of the family.
  template <class Check>
  void for_each_cutter(int cases, const Check& check) const {
    Random random(seed() + 500 + GetParam());
    for (int i = 0; i < int(cases * effort()); ++i) {
      const DropCase c = drop_families()[GetParam()].make(random);
      ASSERT_TRUE(c.terrain);
      const Result<DropCutter> cutter = DropCutter::build(c.terrain, any_radius(random, c));
      ASSERT_TRUE(cutter.ok());
      check(*cutter, c, random);
      if (HasFatalFailure()) return;
    }
  }
};

DropCutter::Raster any_raster(Random& random, const DropCase& c) {
  const Point3 low = c.terrain->lowest(), high = c.terrain->highest();
  DropCutter::Raster raster;
  raster.columns = 1 + random() % 50, raster.rows = 1 + random() % 50;
  const double fineness = exponential(random, -2, 0.5);
  raster.step_x = c.cell * fineness, raster.step_y = c.cell * fineness * exponential(random, -0.3, 0.3);
  raster.first = {uniform(random, low.x - c.cell, high.x), uniform(random, low.y - c.cell, high.y)};
  if (random() % 3 == 0) raster.step_x = -raster.step_x;
  if (random() % 8 == 0) raster.step_y = 0;
  if (random() % 3 == 0) {  // along samples
    raster.first = {low.x, low.y};
    raster.step_x = raster.step_y = c.cell * (random() % 2 == 0 ? 1 : 0.5);
  }
  return raster;
}

TEST_P(DropOrder, RasterEqualsPlaces) {
  for_each_cutter(12, [](const DropCutter& cutter, const DropCase& c, Random& random) {
    const DropCutter::Raster raster = any_raster(random, c);
    std::vector<Contact> one_by_one;
    for (std::size_t row = 0; row < raster.rows; ++row)
      for (std::size_t column = 0; column < raster.columns; ++column)
        one_by_one.push_back(cutter.at(raster.place(column, row)));
    for (const unsigned threads : {1u, 2u, 5u}) {
      Context context;
      context.threads = threads;
      std::vector<Contact> together(one_by_one.size());
      ASSERT_TRUE(cutter.at(raster, together, context).ok());
      for (std::size_t i = 0; i < together.size(); ++i) {
        ASSERT_EQ(one_by_one[i].feature, together[i].feature)
            << c.name << ", radius " << cutter.radius() << ", place " << i << ", heights " << one_by_one[i].height
            << " " << together[i].height;
        ASSERT_EQ(one_by_one[i], together[i]);
      }
    }
  });
}

TEST_P(DropOrder, ListEqualsPlacesInAnyOrder) {
  for_each_cutter(8, [](const DropCutter& cutter, const DropCase& c, Random& random) {
    std::vector<Point> places;
    for (int k = 0; k < 700; ++k) places.push_back(any_place(random, c, cutter.radius()));
    places[13].x = NAN, places[14].y = INFINITY;
    std::vector<Contact> contacts(places.size()), again(places.size());
    ASSERT_TRUE(cutter.at(places, contacts).ok());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Contact alone = cutter.at(places[i]);
      ASSERT_EQ(alone.feature, contacts[i].feature) << c.name << ", radius " << cutter.radius();
      ASSERT_EQ(alone, contacts[i]);
    }
    std::reverse(places.begin(), places.end());
    Context context;
    context.threads = 3;
    ASSERT_TRUE(cutter.at(places, again, context).ok());
    std::reverse(again.begin(), again.end());
    EXPECT_EQ(contacts, again);
  });
}

INSTANTIATE_TEST_SUITE_P(Families, DropOrder, testing::Range<std::size_t>(0, drop_families().size()),
                         [](const auto& info) { return std::string(drop_families()[info.param].name); });

}  // namespace

}  // namespace krepl::test
