// River networks of random and of known lines.
#include "krepl/river.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "river/river_case.hpp"
#include "support/environment.hpp"

namespace krepl::test {
namespace {

using Index = RiverNetwork::Index;

RiverNetwork build(const RiverLines& lines, const RiverOptions& options = {}) {
  auto rivers = RiverNetwork::build(network_of(lines), options);
  EXPECT_TRUE(rivers.ok()) << (rivers ? "" : rivers.error().text());
  return std::move(*rivers);
}

bool has_segment(const RiverLines& lines) {
  return std::any_of(lines.begin(), lines.end(), [](const auto& line) {
    return std::any_of(line.begin(), line.end(), [&](Point p) { return p != line.front(); });
  });
}

TEST(RiverNetwork, AnyLinesOnAGrid) {
  std::mt19937_64 random(seed());
  for (int k = 0; k < int(600 * effort()); ++k) {
    const RiverLines lines = grid_lines(random);
    if (!has_segment(lines)) continue;
    check_rivers(build(lines), lines, true, 1e-12);
    if (HasFailure()) return;
  }
}

TEST(RiverNetwork, AnyCrossingLines) {
  std::mt19937_64 random(seed() + 1);
  std::size_t crossings = 0;
  for (int k = 0; k < int(400 * effort()); ++k) {
    const RiverLines lines = free_lines(random);
    const RiverNetwork rivers = build(lines);
    crossings += rivers.report().crossings;
    EXPECT_LE(rivers.report().largest_move, rivers.report().grid);
    check_rivers(rivers, lines, true, 3 * rivers.report().grid);
    if (HasFailure()) return;
  }
  EXPECT_GT(double(crossings), 2500 * effort());
}

TEST(RiverNetwork, OutletsDrainEverything) {
  std::mt19937_64 random(seed() + 2);
  for (int k = 0; k < int(400 * effort()); ++k) {
    const RiverLines lines = k % 2 == 0 ? grid_lines(random) : free_lines(random);
    if (!has_segment(lines)) continue;
    RiverOptions options;
    options.flow = RiverOptions::Flow::outlet;
    for (std::size_t i = random() % 3; i > 0; --i) {
      const auto& line = lines[random() % lines.size()];
      if (has_segment({line})) options.outlets.push_back(line.front());
    }
    const RiverNetwork rivers = build(lines, options);
    check_rivers(rivers, lines, false, 3 * rivers.report().grid);
    // No cycles but loops, and the only drains are outlets: the given ones, and one in each part without.
    std::size_t loops = 0, drains = 0;
    for (const auto& reach : rivers.reaches()) loops += reach.from == reach.to ? 1 : 0;
    for (const auto& node : rivers.nodes()) drains += node.is_drain() ? 1 : 0;
    EXPECT_EQ(rivers.report().cycle_reaches, loops);
    std::set<std::pair<double, double>> outlets;
    for (Point p : options.outlets) outlets.insert({p.x, p.y});
    EXPECT_LE(drains, outlets.size() + rivers.report().guessed_outlets);
    for (const auto& node : rivers.nodes()) {
      const auto near = [&](const auto& o) { return std::hypot(o.first - node.at.x, o.second - node.at.y) <= 1e-8; };
      EXPECT_TRUE(!node.is_drain() || rivers.report().guessed_outlets > 0 ||
                  std::any_of(outlets.begin(), outlets.end(), near));
    }
    if (HasFailure()) return;
  }
}

TEST(RiverNetwork, SameForAnyNumberOfThreads) {
  std::mt19937_64 random(seed() + 3);
  RiverLines lines;
  for (int i = 0; i < 3000; ++i) {
    const Point p{double(random() % 100000) / 100, double(random() % 100000) / 100};
    lines.push_back({p, {p.x + double(random() % 3000) / 100, p.y + double(random() % 3000) / 100}});
  }
  const Network network = network_of(lines);
  std::vector<std::vector<Point>> answers;
  for (unsigned threads : {1u, 2u, 7u}) {
    Context context;
    context.threads = threads;
    const auto rivers = RiverNetwork::build(network, {}, context);
    ASSERT_TRUE(rivers.ok());
    std::vector<Point> all;
    for (Index s = 0; s < rivers->sub_rivers().size(); ++s) {
      const auto line = rivers->sub_river_line(s);
      all.insert(all.end(), line.begin(), line.end());
    }
    answers.push_back(std::move(all));
  }
  EXPECT_GT(answers[0].size(), 5000u);
  EXPECT_EQ(answers[0], answers[1]);
  EXPECT_EQ(answers[0], answers[2]);
}

// --- known lines -----------------------------------------------------------------------------------------------------

/// A river along x with two tributaries, the second with one of its own.
const RiverLines basin = {
    {{0, 0}, {10, 0}, {20, 0}, {30, 0}}, {{8, 4}, {10, 0}}, {{14, 9}, {18, 3}, {20, 0}}, {{22, 8}, {18, 3}}};

TEST(RiverNetwork, Basin) {
  const RiverNetwork rivers = build(basin);
  ASSERT_EQ(rivers.sub_rivers().size(), 4u);
  const auto sub = rivers.sub_rivers();
  EXPECT_DOUBLE_EQ(sub[0].length, 30);
  EXPECT_TRUE(sub[0].is_stem);
  EXPECT_EQ(sub[0].order, 3u);  // 1 and 1 make 2, another 2 makes 3
  EXPECT_FALSE(sub[0].downstream.has_value());
  EXPECT_EQ(sub[0].feature, 0);
  for (Index s = 1; s < 4; ++s) {
    EXPECT_FALSE(sub[s].is_stem);
    EXPECT_EQ(sub[s].stem, 0u);
    EXPECT_EQ(sub[s].downstream, sub[s].feature == 3 ? 1u : 0u);
  }
  EXPECT_EQ(sub[1].feature, 2);
  EXPECT_EQ(sub[1].order, 2u);
  EXPECT_EQ(rivers.report().touches, 0u);
  EXPECT_EQ(rivers.report().rivers, 1u);
  std::size_t fusions = 0;
  for (const auto& node : rivers.nodes()) fusions += node.is_fusion() ? 1 : 0;
  EXPECT_EQ(fusions, 3u);
}

TEST(RiverNetwork, FeaturesDigitisedAgainstTheFlow) {
  RiverLines lines = basin;
  std::reverse(lines[0].begin(), lines[0].end());
  std::reverse(lines[3].begin(), lines[3].end());
  RiverOptions options;
  options.against = {0, 3};
  const RiverNetwork rivers = build(lines, options), as_it_was = build(basin);
  ASSERT_EQ(rivers.sub_rivers().size(), as_it_was.sub_rivers().size());
  for (Index s = 0; s < 4; ++s) EXPECT_EQ(rivers.sub_river_line(s), as_it_was.sub_river_line(s));
  EXPECT_NE(build(lines).sub_river_line(0), as_it_was.sub_river_line(0));
}

TEST(RiverNetwork, OutletTurnsTheLines) {
  RiverLines lines = basin;
  for (auto& line : lines) std::reverse(line.begin(), line.end());
  RiverOptions options;
  options.flow = RiverOptions::Flow::outlet;
  options.outlets = {{31, 1}};
  const RiverNetwork given = build(lines, options), as_it_was = build(basin);
  EXPECT_DOUBLE_EQ(given.report().outlet_distance, std::sqrt(2));
  EXPECT_EQ(given.report().turned_reaches, given.reaches().size());
  options.outlets.clear();
  const RiverNetwork guessed = build(lines, options);
  EXPECT_EQ(guessed.report().guessed_outlets, 1u);
  for (Index s = 0; s < 4; ++s) {
    EXPECT_EQ(given.sub_river_line(s), as_it_was.sub_river_line(s));
    EXPECT_EQ(guessed.sub_river_line(s), as_it_was.sub_river_line(s));
  }
}

TEST(RiverNetwork, AnOutletInsideOfALineCutsIt) {
  RiverOptions options;
  options.flow = RiverOptions::Flow::outlet;
  options.outlets = {{1, 0}};
  const RiverNetwork rivers = build({{{0, 0}, {1, 0}, {3, 0}}}, options);
  ASSERT_EQ(rivers.sub_rivers().size(), 2u);
  EXPECT_EQ(rivers.sub_river_line(0), (std::vector<Point>{{3, 0}, {1, 0}}));
  EXPECT_EQ(rivers.sub_river_line(1), (std::vector<Point>{{0, 0}, {1, 0}}));
}

TEST(RiverNetwork, EndsAreJoinedWithinTheDistance) {
  // Undershoot, overshoot, an end near a vertex, and one that is too far.
  const RiverLines lines = {{{0, 0}, {10, 0}, {20, 0}},
                            {{5, 5}, {5, 0.25}},
                            {{14, 5}, {14, -0.25}},
                            {{10, -5}, {10.25, -0.25}},
                            {{17, 5}, {17, 0.625}}};
  RiverOptions options;
  options.snap = 0.5;
  const RiverNetwork joined = build(lines, options), apart = build(lines);
  EXPECT_EQ(apart.report().components, 4u);  // the overshoot crosses
  EXPECT_EQ(joined.report().components, 2u);
  EXPECT_EQ(joined.report().ends_to_lines, 2u);
  EXPECT_EQ(joined.report().ends_to_vertices, 1u);
  EXPECT_DOUBLE_EQ(joined.report().largest_move, std::sqrt(0.125));
  EXPECT_EQ(joined.report().crossings, 0u);
  ASSERT_EQ(joined.sub_rivers().size(), 5u);
  EXPECT_DOUBLE_EQ(joined.sub_rivers()[0].length, 20);
  std::set<std::pair<double, double>> ends;
  for (const auto& s : joined.sub_rivers()) ends.insert({joined.nodes()[s.to].at.x, joined.nodes()[s.to].at.y});
  EXPECT_EQ(ends, (std::set<std::pair<double, double>>{{5, 0}, {10, 0}, {14, 0}, {17, 0.625}, {20, 0}}));
}

TEST(RiverNetwork, TwoEndsMeetInOneOfThem) {
  RiverOptions options;
  options.snap = 1;
  const RiverNetwork rivers = build({{{0, 0}, {10, 0}}, {{10.5, 0}, {20, 0}}, {{30, 0}, {20.5, 0}}}, options);
  EXPECT_EQ(rivers.report().ends_to_vertices, 2u);
  EXPECT_EQ(rivers.report().components, 1u);
  EXPECT_DOUBLE_EQ(rivers.report().largest_move, 0.5);
}

TEST(RiverNetwork, JoiningMovesNoEndFurtherThanAsked) {
  std::mt19937_64 random(seed() + 4);
  std::size_t moved = 0;
  for (int k = 0; k < int(300 * effort()); ++k) {
    const RiverLines lines = free_lines(random);
    RiverOptions options;
    options.snap = 4;
    const RiverNetwork rivers = build(lines, options);
    const RiverReport& report = rivers.report();
    moved += report.ends_to_lines + report.ends_to_vertices;
    EXPECT_LE(report.largest_move, 4 * (1 + 1e-12));
    check_rivers(rivers, lines, false, 4.001);
    if (HasFailure()) return;
  }
  EXPECT_GT(double(moved), 300 * effort());
}

TEST(RiverNetwork, SelfCrossingRiverIsTakenApart) {
  // Down, round a loop that crosses the way, and on.
  const RiverNetwork rivers = build({{{0, 0}, {10, 0}, {10, 5}, {5, 5}, {5, -5}}});
  EXPECT_EQ(rivers.report().crossings, 1u);
  EXPECT_EQ(rivers.report().cycle_reaches, 1u);
  ASSERT_EQ(rivers.sub_rivers().size(), 2u);
  EXPECT_EQ(rivers.sub_river_line(0).front(), rivers.sub_river_line(0).back());  // the loop: 5 + 5 + 5 + 5
  EXPECT_DOUBLE_EQ(rivers.sub_rivers()[0].length, 20);
  EXPECT_EQ(rivers.sub_river_line(1), (std::vector<Point>{{0, 0}, {5, 0}, {5, -5}}));
  EXPECT_TRUE(rivers.sub_rivers()[1].is_stem);
  EXPECT_EQ(rivers.sub_rivers()[0].downstream, 1u);
}

TEST(RiverNetwork, DuplicatesAndOverlapsAreCounted) {
  const RiverNetwork rivers = build({{{0, 0}, {10, 0}}, {{0, 0}, {10, 0}}, {{8, 0}, {4, 0}}, {{1, 1}, {1, 1}}});
  const RiverReport& report = rivers.report();
  EXPECT_EQ(report.lines, 3u);
  EXPECT_EQ(report.ignored_points, 1u);
  EXPECT_EQ(report.touches, 4u);
  EXPECT_EQ(report.duplicates, 4u);
  EXPECT_EQ(report.opposed_duplicates, 1u);
  EXPECT_DOUBLE_EQ(report.duplicate_length, 14);
  EXPECT_DOUBLE_EQ(report.input_length, 24);
  ASSERT_EQ(rivers.reaches().size(), 1u);
  EXPECT_DOUBLE_EQ(rivers.reaches()[0].length, 10);
}

TEST(RiverNetwork, LinesThatCollideOrPart) {
  const RiverNetwork rivers = build({{{0, 0}, {1, 0}}, {{2, 0}, {1, 0}}, {{5, 5}, {4, 5}}, {{5, 5}, {7, 5}}});
  EXPECT_EQ(rivers.reaches().size(), 4u);
  EXPECT_EQ(rivers.sub_rivers().size(), 4u);
  EXPECT_EQ(rivers.report().components, 2u);
}

TEST(RiverNetwork, Rings) {
  const RiverNetwork rivers = build({{{0, 0}, {1, 0}, {1, 1}, {0, 0}}});
  ASSERT_EQ(rivers.sub_rivers().size(), 1u);
  EXPECT_TRUE(rivers.reaches()[0].closes_cycle);
  EXPECT_EQ(rivers.sub_river_line(0).size(), 4u);
}

TEST(RiverNetwork, ACoarserGridMakesNearThingsOne) {
  RiverOptions options;
  options.grid = 0.3;
  const RiverNetwork rivers = build({{{0, 0}, {10, 0}}, {{5, 5}, {5, 0.1}}, {{12, 4}, {10.05, 0.05}}}, options);
  EXPECT_EQ(rivers.report().grid, 0.25);
  EXPECT_EQ(rivers.report().components, 1u);
  EXPECT_DOUBLE_EQ(rivers.report().largest_move, 0.1);
  EXPECT_EQ(rivers.sub_rivers().size(), 3u);

  std::mt19937_64 random(seed() + 5);
  for (int k = 0; k < int(300 * effort()); ++k) {  // coarse beside the lines themselves: much collapses
    const RiverLines lines = free_lines(random);
    options.grid = k % 2 == 0 ? 1 : 16;
    const auto coarse = RiverNetwork::build(network_of(lines), options);
    if (!coarse || coarse->report().ignored_points > 0) continue;  // a whole line within a pixel is none
    EXPECT_LE(coarse->report().largest_move, options.grid * 0.7072);
    check_rivers(*coarse, lines, false, 1.5 * options.grid);
    if (HasFailure()) return;
  }
}

TEST(RiverNetwork, Refusals) {
  const Network points = network_of({{{1, 2}}, {{3, 4}, {3, 4}}});
  EXPECT_EQ(RiverNetwork::build(points).error().code, ErrorCode::input);
  const Network line = network_of({{{1, 2}, {3, 4}}});
  RiverOptions options;
  options.snap = -1;
  EXPECT_EQ(RiverNetwork::build(line, options).error().code, ErrorCode::usage);
  options = {};
  options.outlets = {{NAN, 0}};
  EXPECT_EQ(RiverNetwork::build(line, options).error().code, ErrorCode::usage);
  std::atomic<bool> stop = true;
  Context context;
  context.cancel = &stop;
  EXPECT_EQ(RiverNetwork::build(line, {}, context).error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace krepl::test
