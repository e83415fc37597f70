// Tools by their text: the profile's points, continuity and convexity, the way back to text, and what is refused.
#include "krepl/cutter.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace krepl::test {

namespace {

Cutter tool(std::string_view text) {
  Result<Cutter> cutter = Cutter::parse(text);
  EXPECT_TRUE(cutter.ok()) << text << ": " << cutter.error().text();
  return *cutter;
}

const char* const all_tools[] = {"ball:6",        "flat:10",      "bull:10:2",       "bull:6:3",
                                 "bull:8:0.001",  "cone:6:90",    "cone:6:60",       "cone:5:12",
                                 "cone:20:170.5", "taper:6:10:1", "taper:12.5:90:2", "taper:3:178:2"};

TEST(Cutter, TextComesBack) {
  for (const char* text : all_tools) {
    EXPECT_EQ(tool(text).text(), text);
    EXPECT_EQ(tool(tool(text).text()), tool(text));
  }
}

TEST(Cutter, HeightsThatAreKnown) {
  EXPECT_DOUBLE_EQ(tool("ball:10").height(3), 1);
  EXPECT_DOUBLE_EQ(tool("ball:10").height(5), 5);
  EXPECT_EQ(tool("flat:10").height(5), 0);
  EXPECT_EQ(tool("bull:20:5").height(5), 0);
  EXPECT_DOUBLE_EQ(tool("bull:20:5").height(9), 2);
  EXPECT_EQ(tool("cone:10:90").height(3.25), 3.25);
  EXPECT_NEAR(tool("cone:10:60").height(3), 3 * std::sqrt(3.0), 1e-14);
  // The tip's ball of radius 1 ends where its tangent rises by 1, at 1/sqrt(2) out and 1 - 1/sqrt(2) up.
  const double at = std::sqrt(0.5);
  EXPECT_NEAR(tool("taper:6:90:1").corner_end(), at, 1e-15);
  EXPECT_NEAR(tool("taper:6:90:1").height(2), 1 - at + (2 - at), 1e-15);
  EXPECT_EQ(tool("ball:10").control_height(), 5);
  EXPECT_EQ(tool("bull:10:5").control_height(), 0);
}

TEST(Cutter, ProfilesAreConvexAndEndAtTheRadius) {
  for (const char* text : all_tools) {
    const Cutter cutter = tool(text);
    const double step = cutter.radius() / 1024;
    EXPECT_EQ(cutter.height(0), 0);
    double rise = 0;
    for (int i = 1; i <= 1024; ++i) {
      const double now = cutter.height(i * step) - cutter.height((i - 1) * step);
      EXPECT_GE(now, rise - 1e-13 * cutter.radius()) << text << " at " << i * step;
      rise = now;
    }
    EXPECT_TRUE(std::isinf(cutter.height(cutter.radius() * (1 + 1e-15)))) << text;
  }
}

TEST(Cutter, WhatIsRefused) {
  for (const char* text :
       {"",         "drill:3",    "ball",       "ball:",      "ball:x",       "ball:3mm",       "ball:-1",
        "ball:0",   "ball:nan",   "ball:inf",   "ball:3:1",   "bull:6",       "bull:6:3.1",     "bull:6:0",
        "cone:6:0", "cone:6:180", "cone:6:nan", "taper:6:10", "taper:6:90:5", "taper:6:10:3.1", " ball:3"}) {
    const Result<Cutter> cutter = Cutter::parse(text);
    ASSERT_FALSE(cutter.ok()) << text;
    EXPECT_EQ(cutter.error().code, ErrorCode::usage);
    EXPECT_FALSE(cutter.error().remedy.empty()) << text;
  }
}

}  // namespace

}  // namespace krepl::test
