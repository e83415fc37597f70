// Orders, stems and sub-rivers of random graphs against their definitions, worked out anew by recursion.
#include "river/hierarchy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <set>

#include "support/environment.hpp"

namespace krepl::test {
namespace {

using river::Hierarchy;
using river::Link;
using Index = std::uint32_t;

struct Graph {
  Index nodes;
  std::vector<Link> links;
};

Graph random_graph(std::mt19937_64& random, bool acyclic) {
  Graph g{Index(2 + random() % 7), {}};
  const std::size_t count = 1 + random() % 10;
  while (g.links.size() < count) {
    Index a = Index(random() % g.nodes), b = Index(random() % g.nodes);
    if (acyclic && a == b) continue;
    if (acyclic && a > b) std::swap(a, b);
    g.links.push_back({a, b, double(1 + random() % 4)});  // ties are ordinary
  }
  return g;
}

/// All links lead to lower numbers and every node but 0 has one: a tree with its drain at 0.
Graph random_tree(std::mt19937_64& random) {
  Graph g{Index(2 + random() % 12), {}};
  for (Index n = 1; n < g.nodes; ++n) g.links.push_back({n, Index(random() % n), double(1 + random() % 4)});
  return g;
}

/// The longest way that starts with this link, by trying all.
double longest_down(const Graph& g, Index link) {
  double best = 0;
  for (Index l = 0; l < g.links.size(); ++l) {
    if (g.links[l].from == g.links[link].to) best = std::max(best, longest_down(g, l));
  }
  return g.links[link].length + best;
}

/// True if a link's end leads back to its start by links that are not left out.
bool reaches(const Graph& g, const std::vector<bool>& left_out, Index from, Index to) {
  std::set<Index> seen{from};
  std::vector<Index> open{from};
  while (!open.empty()) {
    const Index n = open.back();
    open.pop_back();
    if (n == to) return true;
    for (Index l = 0; l < g.links.size(); ++l) {
      if (!left_out[l] && g.links[l].from == n && seen.insert(g.links[l].to).second) open.push_back(g.links[l].to);
    }
  }
  return false;
}

void check_sub_rivers(const Graph& g, const Hierarchy& h) {
  std::vector<int> times(g.links.size(), 0);
  for (Index s = 0; s < h.sub_rivers.size(); ++s) {
    const Hierarchy::SubRiver& river = h.sub_rivers[s];
    ASSERT_FALSE(river.links.empty());
    EXPECT_LE(river.length, h.sub_rivers[s == 0 ? 0 : s - 1].length);
    std::set<Index> visited{g.links[river.links.front()].from};
    double length = 0;
    for (std::size_t i = 0; i < river.links.size(); ++i) {
      const Link& link = g.links[river.links[i]];
      ++times[river.links[i]];
      EXPECT_EQ(h.sub_river[river.links[i]], s);
      EXPECT_TRUE(i == 0 || g.links[river.links[i - 1]].to == link.from);
      const bool loop = river.links.size() == 1 && link.from == link.to;
      EXPECT_TRUE(visited.insert(link.to).second || loop);
      length += link.length;
    }
    EXPECT_DOUBLE_EQ(length, river.length);
    const Index end = g.links[river.links.back()].to;
    if (river.downstream != Hierarchy::none) {  // it passes the end, or starts or ends there
      EXPECT_NE(river.downstream, s);
      const auto& links = h.sub_rivers[river.downstream].links;
      EXPECT_TRUE(std::any_of(links.begin(), links.end(),
                              [&](Index l) { return g.links[l].to == end || g.links[l].from == end; }));
    }
    EXPECT_EQ(h.sub_rivers[river.stem].stem, river.stem);
  }
  EXPECT_TRUE(std::all_of(times.begin(), times.end(), [](int t) { return t == 1; }));
}

TEST(Hierarchy, SubRiversPartTheLinksOfAnyGraph) {
  std::mt19937_64 random(seed());
  for (int k = 0; k < int(3000 * effort()); ++k) {
    const Graph g = random_graph(random, k % 2 == 0);
    const Hierarchy h = river::make_hierarchy(g.nodes, g.links);
    check_sub_rivers(g, h);
    std::vector<bool> left_out = h.closes_cycle;
    for (Index l = 0; l < g.links.size(); ++l) {
      const bool back = reaches(g, left_out, g.links[l].to, g.links[l].from);
      // What is left out closes a cycle with what is kept, and what is kept has none.
      EXPECT_EQ(back, h.closes_cycle[l]);
      EXPECT_FALSE(k % 2 == 0 && h.closes_cycle[l]);
    }
    if (testing::Test::HasFailure()) return;
  }
}

TEST(Hierarchy, TheLongestWayIsOneSubRiver) {
  std::mt19937_64 random(seed() + 1);
  for (int k = 0; k < int(2000 * effort()); ++k) {
    Graph g = random_graph(random, true);
    // No ties: of two equally long ways to one drain, one may turn off from the other.
    for (Link& link : g.links) link.length += std::ldexp(double(random() % 1024), -11);
    const Hierarchy h = river::make_hierarchy(g.nodes, g.links);
    double longest = 0;
    for (Index l = 0; l < g.links.size(); ++l) longest = std::max(longest, longest_down(g, l));
    EXPECT_DOUBLE_EQ(h.sub_rivers.front().length, longest);
    EXPECT_EQ(h.sub_rivers.front().stem, 0u);
  }
}

/// Strahler's definition, for trees.
Index strahler(const Graph& g, Index link) {
  std::map<Index, int, std::greater<>> count;
  for (Index l = 0; l < g.links.size(); ++l) {
    if (g.links[l].to == g.links[link].from) ++count[strahler(g, l)];
  }
  if (count.empty()) return 1;
  return count.begin()->second > 1 ? count.begin()->first + 1 : count.begin()->first;
}

TEST(Hierarchy, StrahlersOrderInTrees) {
  std::mt19937_64 random(seed() + 2);
  Index highest = 0;
  for (int k = 0; k < int(1000 * effort()); ++k) {
    const Graph g = random_tree(random);
    const Hierarchy h = river::make_hierarchy(g.nodes, g.links);
    for (Index l = 0; l < g.links.size(); ++l) {
      EXPECT_EQ(h.order[l], strahler(g, l));
      highest = std::max(highest, h.order[l]);
    }
    // One stem for what comes to the drain; everything else joins something.
    std::size_t stems = 0;
    for (Index t = 0; t < h.sub_rivers.size(); ++t) {
      const bool joins = h.sub_rivers[t].downstream != Hierarchy::none;
      EXPECT_EQ(joins, h.sub_rivers[t].stem != t);
      stems += joins ? 0 : 1;
    }
    EXPECT_EQ(stems, 1u);
  }
  if (effort() >= 1) {
    EXPECT_GE(highest, 3u);
  }
}

TEST(Hierarchy, BraidsDoNotRaiseTheOrder) {
  // 0 -> 1 braids to 2 twice, then 2 -> 3; a tributary 4 -> 3 of the first order; 3 -> 5.
  const Graph g{6, {{0, 1, 5}, {1, 2, 2}, {1, 2, 1}, {2, 3, 1}, {4, 3, 1}, {3, 5, 1}}};
  const Hierarchy h = river::make_hierarchy(g.nodes, g.links);
  EXPECT_EQ(h.order, (std::vector<Index>{1, 1, 1, 1, 1, 2}));
  ASSERT_EQ(h.sub_rivers.size(), 3u);
  EXPECT_EQ(h.sub_rivers[0].links, (std::vector<Index>{0, 1, 3, 5}));  // by the longer arm
  EXPECT_EQ(h.sub_rivers[1].downstream, 0u);
  EXPECT_EQ(h.sub_rivers[2].downstream, 0u);
}

TEST(Hierarchy, DeltaBelongsToItsRiver) {
  // 0 -> 1, then two mouths 2 and 3; a second river 4 -> 5.
  const Graph g{6, {{0, 1, 5}, {1, 2, 2}, {1, 3, 1}, {4, 5, 1}}};
  const Hierarchy h = river::make_hierarchy(g.nodes, g.links);
  ASSERT_EQ(h.sub_rivers.size(), 3u);
  EXPECT_EQ(h.sub_rivers[0].links, (std::vector<Index>{0, 1}));
  for (Index s = 1; s < 3; ++s) {
    EXPECT_EQ(h.sub_rivers[s].downstream, Hierarchy::none);
    EXPECT_EQ(h.sub_rivers[s].stem, h.sub_rivers[s].links.front() == 2 ? 0u : s);
  }
}

}  // namespace
}  // namespace krepl::test
