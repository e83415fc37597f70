// Which way water runs when the lines do not say: to the outlet.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>

#include "river/reaches.hpp"

namespace krepl::river {
namespace {

constexpr Index none = ~Index{0};

/// Sets of nodes that are connected.
class Parts {
 public:
  explicit Parts(std::size_t nodes) : above_(nodes) { std::iota(above_.begin(), above_.end(), Index{0}); }
  Index find(Index n) {
    while (above_[n] != n) n = above_[n] = above_[above_[n]];
    return n;
  }
  /// False if they were connected already.
  bool join(Index a, Index b) {
    a = find(a), b = find(b);
    above_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

 private:
  std::vector<Index> above_;
};

/// The order in which water that went upstream from the outlets, everywhere at once, would come to the nodes
/// [dijkstra1959].
std::vector<Index> distance_ranks(const Reaches& reaches, const std::vector<Index>& outlets) {
  const std::size_t count = reaches.node.size();
  std::vector<std::vector<Index>> at(count);
  for (Index r = 0; r < reaches.reaches.size(); ++r) {
    at[reaches.reaches[r].from].push_back(r);
    at[reaches.reaches[r].to].push_back(r);
  }
  using Entry = std::pair<double, Index>;  // distance, node
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  std::vector<double> distance(count, std::numeric_limits<double>::infinity());
  std::vector<Index> rank(count, none);
  for (Index n : outlets) {
    distance[n] = 0;
    queue.emplace(0, n);
  }
  for (Index next = 0; !queue.empty();) {
    const auto [d, n] = queue.top();
    queue.pop();
    if (rank[n] != none) continue;
    rank[n] = next++;
    for (Index r : at[n]) {
      const Reaches::Reach& reach = reaches.reaches[r];
      const Index other = reach.from == n ? reach.to : reach.from;
      if (d + reach.length >= distance[other]) continue;
      distance[other] = d + reach.length;
      queue.emplace(distance[other], other);
    }
  }
  return rank;
}

}  // namespace

OutletGuess::OutletGuess(const Reaches& reaches, const Edges& edges)
    : reaches_(reaches),
      arms_(reaches.node.size()),
      degree_(reaches.node.size(), 0),
      arrives_(reaches.node.size(), false),
      sum_(reaches.node.size()) {
  Parts parts(reaches.node.size());
  for (const Reaches::Reach& reach : reaches.reaches) {
    ++degree_[reach.from], ++degree_[reach.to];
    arrives_[reach.to] = true;
    if (!parts.join(reach.from, reach.to)) continue;
    const Point out = heading(reach, false, edges), back = heading(reach, true, edges);
    arms_[reach.from].push_back({reach.to, out, back});
    arms_[reach.to].push_back({reach.from, back, out});
    sum_[reach.from] = {sum_[reach.from].x + out.x, sum_[reach.from].y + out.y};
    sum_[reach.to] = {sum_[reach.to].x + back.x, sum_[reach.to].y + back.y};
  }
}

/// From a node towards the place a tenth of the reach away: the first vertex may be a quirk of digitising, and bends
/// further off say nothing of the confluence.
Point OutletGuess::heading(const Reaches::Reach& reach, bool at_end, const Edges& edges) const {
  const std::size_t count = reach.last - reach.first;
  const auto place = [&](std::size_t i) {
    return edges.place(reaches_.chain[at_end ? reach.last - 1 - i : reach.first + i]);
  };
  const Point start = place(0);
  double way = 0;
  for (std::size_t i = 1; i < count; ++i) {
    const Point p = place(i), q = place(i - 1);
    way += std::hypot(p.x - q.x, p.y - q.y);
    const double dx = p.x - start.x, dy = p.y - start.y, d = std::hypot(dx, dy);
    if ((way >= reach.length / 10 || i + 1 == count) && d > 0) return {dx / d, dy / d};
  }
  return {};
}

/// Sum of the cosines of turns from all other arms into the one that leads down.
double OutletGuess::gain(Index node, Point down) const {
  if (arms_[node].size() < 2) return 0;
  return (down.x - sum_[node].x) * down.x + (down.y - sum_[node].y) * down.y;
}

Index OutletGuess::outlet(const std::vector<Index>& nodes) {
  // The score of one end of the tree follows from its neighbour's: only what they hold of each other as downstream
  // changes.
  const Index root = nodes.front();
  Index best = none;
  double best_score = 0;
  struct Visit {
    Index node, from;
    double score;
  };
  const bool has_ends = std::any_of(nodes.begin(), nodes.end(), [&](Index n) { return degree_[n] == 1; });
  std::vector<Visit> stack{{root, none, 0}};
  while (!stack.empty()) {
    const Visit v = stack.back();
    stack.pop_back();
    const bool candidate = !has_ends || degree_[v.node] == 1;
    const auto better = [&] {
      if (best == none || v.score != best_score) return best == none || v.score > best_score;
      return arrives_[v.node] != arrives_[best] ? bool(arrives_[v.node]) : v.node < best;
    };
    if (candidate && better()) best = v.node, best_score = v.score;
    for (const Arm& arm : arms_[v.node]) {
      if (arm.node == v.from) continue;
      stack.push_back({arm.node, v.node, v.score - gain(arm.node, arm.heading_there) + gain(v.node, arm.heading)});
    }
  }
  return best;
}

void direct_to_outlets(Reaches& reaches, const Edges& edges, const std::vector<Index>& given, RiverReport& report) {
  Parts parts(reaches.node.size());
  for (const Reaches::Reach& reach : reaches.reaches) parts.join(reach.from, reach.to);
  std::vector<std::vector<Index>> members(reaches.node.size());
  for (Index n = 0; n < reaches.node.size(); ++n) members[parts.find(n)].push_back(n);
  std::vector<Index> outlets = given;
  std::vector<bool> drained(reaches.node.size(), false);
  for (Index n : outlets) drained[parts.find(n)] = true;
  OutletGuess guess(reaches, edges);
  for (Index n = 0; n < reaches.node.size(); ++n) {
    if (members[n].empty() || drained[n]) continue;
    outlets.push_back(guess.outlet(members[n]));
    ++report.guessed_outlets;
  }
  const std::vector<Index> rank = distance_ranks(reaches, outlets);
  for (Reaches::Reach& reach : reaches.reaches) {
    if (rank[reach.from] < rank[reach.to]) reaches.turn(reach);
    if (reach.against > reach.length / 2) ++report.turned_reaches;
  }
}

}  // namespace krepl::river
