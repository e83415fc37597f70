#include "river/reaches.hpp"

#include <algorithm>
#include <map>

namespace krepl::river {
namespace {

constexpr Index none = ~Index{0};

/// The edges at each vertex.
class Incidence {
 public:
  explicit Incidence(const Edges& edges) : begin_(edges.vertices.size() + 1, 0), edge_(2 * edges.edges.size()) {
    for (const Edge& e : edges.edges) ++begin_[e.from + 1], ++begin_[e.to + 1];
    for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
    std::vector<Index> at(begin_.begin(), begin_.end() - 1);
    for (Index e = 0; e < edges.edges.size(); ++e) {
      edge_[at[edges.edges[e].from]++] = e;
      edge_[at[edges.edges[e].to]++] = e;
    }
  }
  std::span<const Index> at(Index vertex) const {
    return {edge_.data() + begin_[vertex], begin_[vertex + 1] - begin_[vertex]};
  }

 private:
  std::vector<Index> begin_, edge_;
};

class Chaining {
 public:
  Chaining(const Edges& edges, bool directed)
      : edges_(edges),
        incidence_(edges),
        directed_(directed),
        done_(edges.edges.size(), false),
        node_of_(edges.vertices.size(), none) {}

  Reaches run(const std::vector<Index>& more) {
    std::vector<bool> wanted(edges_.vertices.size(), false);
    for (Index v : more) wanted[v] = !incidence_.at(v).empty();
    for (Index v = 0; v < wanted.size(); ++v) {
      if (wanted[v] || ends_here(v)) add_node(v);
    }
    mark_rings();
    std::sort(result_.node.begin(), result_.node.end());
    for (Index n = 0; n < result_.node.size(); ++n) node_of_[result_.node[n]] = n;
    std::fill(done_.begin(), done_.end(), false);
    for (Index v : result_.node) {
      for (Index e : incidence_.at(v)) {
        if (!done_[e]) add_reach(v, e);
      }
    }
    return std::move(result_);
  }

 private:
  bool ends_here(Index v) const {
    const auto at = incidence_.at(v);
    if (at.size() != 2) return !at.empty();
    return directed_ && (edges_.edges[at[0]].to == v) == (edges_.edges[at[1]].to == v);
  }
  void add_node(Index v) {
    node_of_[v] = 0;
    result_.node.push_back(v);
  }
  Index other_end(Index e, Index v) const {
    return edges_.edges[e].from == v ? edges_.edges[e].to : edges_.edges[e].from;
  }
  /// The other one of the two edges at a vertex that is no node.
  Index next_edge(Index e, Index v) const {
    const auto at = incidence_.at(v);
    return at[0] == e ? at[1] : at[0];
  }

  void mark_rings() {
    for (Index v : result_.node) {
      for (Index e : incidence_.at(v)) walk(v, e, [](Index, Index) {});
    }
    for (Index v = 0; v < node_of_.size(); ++v) {
      const auto at = incidence_.at(v);
      if (at.empty() || done_[at[0]]) continue;
      add_node(v);
      walk(v, at[0], [](Index, Index) {});
    }
  }

  /// From a node along an edge to the next node; visit(edge, vertex that it leads to).
  template <class Visit>
  void walk(Index v, Index e, Visit visit) {
    for (;;) {
      done_[e] = true;
      v = other_end(e, v);
      visit(e, v);
      if (node_of_[v] != none) return;
      e = next_edge(e, v);
    }
  }

  void add_reach(Index v, Index e) {
    Reaches::Reach reach{};
    reach.from = node_of_[v];
    reach.first = result_.chain.size();
    result_.chain.push_back(v);
    std::map<std::int64_t, double> share;
    walk(v, e, [&](Index edge, Index to) {
      const double length = edges_.length(edges_.edges[edge]);
      reach.length += length;
      if (edges_.edges[edge].to != to) reach.against += length;
      share[edges_.edges[edge].feature] += length;
      result_.chain.push_back(to);
    });
    reach.last = result_.chain.size();
    reach.to = node_of_[result_.chain.back()];
    reach.feature = std::max_element(share.begin(), share.end(), [](const auto& a, const auto& b) {
                      return a.second < b.second;
                    })->first;
    if (reach.against > reach.length / 2) result_.turn(reach);
    result_.reaches.push_back(reach);
  }

  const Edges& edges_;
  const Incidence incidence_;
  const bool directed_;
  std::vector<bool> done_;
  std::vector<Index> node_of_;
  Reaches result_;
};

}  // namespace

void Reaches::turn(Reach& reach) {
  std::swap(reach.from, reach.to);
  std::reverse(chain.begin() + std::ptrdiff_t(reach.first), chain.begin() + std::ptrdiff_t(reach.last));
  reach.against = reach.length - reach.against;
}

Reaches make_reaches(const Edges& edges, const std::vector<Index>& more, bool directed) {
  return Chaining(edges, directed).run(more);
}

}  // namespace krepl::river
