#include "river/hierarchy.hpp"

#include <algorithm>

namespace krepl::river {
namespace {

using Index = std::uint32_t;
constexpr Index none = Hierarchy::none;

class Ranking {
 public:
  Ranking(std::size_t nodes, std::span<const Link> links)
      : links_(links),
        in_(nodes),
        out_(nodes),
        best_in_(nodes, none),
        best_out_(nodes, none),
        up_(links.size()),
        down_(links.size()) {
    for (Index l = 0; l < links.size(); ++l) out_[links[l].from].push_back(l);
    h_.closes_cycle.resize(links.size(), false);
    h_.order.resize(links.size(), 0);
    h_.sub_river.resize(links.size(), none);
  }

  Hierarchy run() {
    find_cycles();
    for (std::vector<Index>& links : out_) std::erase_if(links, [&](Index l) { return h_.closes_cycle[l]; });
    for (Index l = 0; l < links_.size(); ++l) {
      if (!h_.closes_cycle[l]) in_[links_[l].to].push_back(l);
    }
    sort_nodes();
    measure_ways();
    tell_orders();
    trace();
    join();
    return std::move(h_);
  }

 private:
  /// A link to a node that the search is still at closes a cycle.
  void find_cycles() {
    std::vector<Index> arrivals(out_.size(), 0);
    for (const Link& link : links_) ++arrivals[link.to];
    enum : char { fresh, open, closed };
    std::vector<char> state(out_.size(), fresh);
    std::vector<std::pair<Index, std::size_t>> path;  // node, the next of its links to take
    const auto search = [&](Index root) {
      if (state[root] != fresh) return;
      state[root] = open;
      path.emplace_back(root, 0);
      while (!path.empty()) {
        const Index node = path.back().first;
        const std::size_t next = path.back().second++;
        if (next == out_[node].size()) {
          state[node] = closed;
          path.pop_back();
          continue;
        }
        const Index link = out_[node][next], to = links_[link].to;
        if (state[to] == open) h_.closes_cycle[link] = true;
        if (state[to] != fresh) continue;
        state[to] = open;
        path.emplace_back(to, 0);
      }
    };
    for (Index n = 0; n < out_.size(); ++n) {
      if (arrivals[n] == 0) search(n);
    }
    for (Index n = 0; n < out_.size(); ++n) search(n);
  }

  /// Every node before those downstream of it.
  void sort_nodes() {
    std::vector<std::size_t> missing(in_.size());
    for (Index n = 0; n < in_.size(); ++n) {
      missing[n] = in_[n].size();
      if (missing[n] == 0) sorted_.push_back(n);
    }
    for (std::size_t i = 0; i < sorted_.size(); ++i) {
      for (Index l : out_[sorted_[i]]) {
        if (--missing[links_[l].to] == 0) sorted_.push_back(links_[l].to);
      }
    }
  }

  Index longest(const std::vector<Index>& links, const std::vector<double>& way) const {
    Index best = none;
    for (Index l : links) {
      if (best == none || way[l] > way[best]) best = l;
    }
    return best;
  }

  void measure_ways() {
    for (Index n : sorted_) {
      best_in_[n] = longest(in_[n], up_);
      for (Index l : out_[n]) up_[l] = links_[l].length + (best_in_[n] == none ? 0 : up_[best_in_[n]]);
    }
    for (auto n = sorted_.rbegin(); n != sorted_.rend(); ++n) {
      best_out_[*n] = longest(out_[*n], down_);
      for (Index l : in_[*n]) down_[l] = links_[l].length + (best_out_[*n] == none ? 0 : down_[best_out_[*n]]);
    }
  }

  /// Strahler's order of what leaves a node, and whether it may raise the order of what it joins.
  struct Rank {
    Index order = 1;
    bool raises = true;
  };
  Rank rank_of(Index node, const std::vector<bool>& raises) const {
    Index highest = 0, count = 0, other = 0;
    for (Index l : in_[node]) {
      if (!raises[l]) {
        other = std::max(other, h_.order[l]);
      } else if (h_.order[l] >= highest) {
        count = h_.order[l] == highest ? count + 1 : 1;
        highest = h_.order[l];
      }
    }
    if (highest > 0) return {count > 1 ? highest + 1 : highest, true};
    return other > 0 ? Rank{other, false} : Rank{};
  }

  void tell_orders() {
    std::vector<bool> raises(links_.size(), false);
    std::vector<Index> order(in_.size(), 1);
    for (Index n : sorted_) {
      const Rank rank = rank_of(n, raises);
      order[n] = rank.order;
      for (Index l : out_[n]) {
        h_.order[l] = rank.order;
        raises[l] = rank.raises && l == best_out_[n];
      }
    }
    for (Index l = 0; l < links_.size(); ++l) {
      if (h_.closes_cycle[l]) h_.order[l] = order[links_[l].from];
    }
  }

  /// True if what comes to the link's start goes on in it.
  bool continues(Index l) const {
    const Index node = links_[l].from;
    return !h_.closes_cycle[l] && best_out_[node] == l && best_in_[node] != none;
  }

  void trace() {
    for (Index l = 0; l < links_.size(); ++l) {
      if (continues(l)) continue;
      Hierarchy::SubRiver river;
      for (Index at = l;;) {
        river.links.push_back(at);
        river.length += links_[at].length;
        const Index end = links_[at].to;
        if (h_.closes_cycle[at] || best_in_[end] != at || best_out_[end] == none) break;
        at = best_out_[end];
      }
      h_.sub_rivers.push_back(std::move(river));
    }
    // Of equally long ones that meet, the one that goes on ends in the link with the lower number.
    std::sort(h_.sub_rivers.begin(), h_.sub_rivers.end(), [](const auto& a, const auto& b) {
      return a.length != b.length ? a.length > b.length : a.links.back() < b.links.back();
    });
    for (Index s = 0; s < h_.sub_rivers.size(); ++s) {
      for (Index l : h_.sub_rivers[s].links) h_.sub_river[l] = s;
    }
  }

  Index river_through(Index node) const {
    const Index link = best_in_[node] != none ? best_in_[node] : best_out_[node];
    return link == none ? none : h_.sub_river[link];
  }

  /// Where each sub-river goes, and the stem it belongs to: that of the one it joins, else of the one it branches off.
  void join() {
    const Index count = Index(h_.sub_rivers.size());
    std::vector<Index> above(count, none);
    for (Index s = 0; s < count; ++s) {
      Hierarchy::SubRiver& river = h_.sub_rivers[s];
      const Index joined = river_through(links_[river.links.back()].to);
      if (joined != s) river.downstream = joined;
      const Index start = links_[river.links.front()].from,
                  left = best_in_[start] == none ? none : h_.sub_river[best_in_[start]];
      above[s] = river.downstream != none ? river.downstream : left != s ? left : none;
    }
    std::vector<Index> walk(count, none);  // the last one that came by
    for (Index s = 0; s < count; ++s) {
      std::vector<Index> path;
      Index at = s;
      for (; h_.sub_rivers[at].stem == none && above[at] != none && walk[at] != s; at = above[at]) {
        walk[at] = s;
        path.push_back(at);
      }
      if (h_.sub_rivers[at].stem == none) {
        // Equal lengths in a braid can make two sub-rivers each other's: then the longest (first) one is the stem.
        const auto repeated = std::find(path.begin(), path.end(), at);
        if (repeated != path.end()) at = *std::min_element(repeated, path.end());
        h_.sub_rivers[at].stem = at;
      }
      for (Index p : path) h_.sub_rivers[p].stem = h_.sub_rivers[at].stem;
    }
  }

  std::span<const Link> links_;
  std::vector<std::vector<Index>> in_, out_;  // per node, without what closes cycles
  std::vector<Index> sorted_, best_in_, best_out_;
  std::vector<double> up_, down_;  // per link: longest way with it to a source, to a drain
  Hierarchy h_;
};

}  // namespace

Hierarchy make_hierarchy(std::size_t node_count, std::span<const Link> links) {
  return Ranking(node_count, links).run();
}

}  // namespace krepl::river
