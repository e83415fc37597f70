#include "krepl/river.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_set>

#include "river/hierarchy.hpp"
#include "river/reaches.hpp"

namespace krepl {

using river::Edges;
using river::Hierarchy;
using river::Reaches;

/// The stages of RiverNetwork::build in their order.
class RiverBuilder {
 public:
  RiverBuilder(const Network& network, const RiverOptions& options, const Context& context)
      : network_(network), options_(options), context_(context) {}

  Result<RiverNetwork> run() {
    if (Status sound = check(); !sound) return sound.error();
    river::Lines lines = river::take_lines(network_, options_.grid, report_);
    if (lines.line_count() == 0) {
      return Error{ErrorCode::input, "there is no line in the input", "",
                   "give lines with two different vertices at least"};
    }
    if (options_.flow == RiverOptions::Flow::digitised) turn_lines(lines);
    const Error cancelled{ErrorCode::cancelled, "cancelled", "", ""};
    if (!river::snap_ends(lines, options_.snap, report_, context_)) return cancelled;
    std::optional<Edges> edges = river::node_lines(lines, report_, context_);
    if (!edges) return cancelled;
    if (edges->edges.empty()) {
      return Error{ErrorCode::input, "nothing is left of the lines", "", "give a smaller distance to join ends"};
    }
    const Reaches reaches = directed_reaches(*edges);
    if (context_.cancelled()) return cancelled;
    fill(*edges, reaches);
    result_.report_ = report_;
    return std::move(result_);
  }

 private:
  Status check() const {
    if (!(options_.snap >= 0) || !std::isfinite(options_.snap)) {
      return Error{ErrorCode::usage, "the distance to join ends is negative or not finite", "", "give 0 or more"};
    }
    if (!(options_.grid >= 0) || !std::isfinite(options_.grid)) {
      return Error{ErrorCode::usage, "the pitch of the grid is negative or not finite", "", "give 0 or more"};
    }
    for (const Point& p : options_.outlets) {
      if (!std::isfinite(p.x) || !std::isfinite(p.y)) {
        return Error{ErrorCode::usage, "an outlet's coordinates are not finite", "", "give two numbers"};
      }
    }
    return std::monostate{};
  }

  void turn_lines(river::Lines& lines) const {
    const std::unordered_set<std::int64_t> against(options_.against.begin(), options_.against.end());
    for (std::size_t line = 0; line < lines.line_count(); ++line) {
      if (!against.contains(lines.feature[line])) continue;
      std::reverse(lines.chain.begin() + std::ptrdiff_t(lines.begin[line]),
                   lines.chain.begin() + std::ptrdiff_t(lines.begin[line + 1]));
    }
  }

  Reaches directed_reaches(const Edges& edges) {
    if (options_.flow == RiverOptions::Flow::digitised) return river::make_reaches(edges, {}, true);
    const std::vector<river::Index> vertices = outlet_vertices(edges);
    Reaches reaches = river::make_reaches(edges, vertices, false);
    std::vector<river::Index> nodes;
    for (river::Index v : vertices) {
      nodes.push_back(
          river::Index(std::lower_bound(reaches.node.begin(), reaches.node.end(), v) - reaches.node.begin()));
    }
    river::direct_to_outlets(reaches, edges, nodes, report_);
    return reaches;
  }

  /// The vertices nearest to the outlets.
  std::vector<river::Index> outlet_vertices(const Edges& edges) {
    std::vector<river::Index> vertices;
    for (const Point& outlet : options_.outlets) {
      river::Index nearest = edges.edges.front().from;
      double least = INFINITY;
      for (const river::Edge& e : edges.edges) {
        for (river::Index v : {e.from, e.to}) {
          const Point p = edges.place(v);
          const double d = std::hypot(p.x - outlet.x, p.y - outlet.y);
          if (d < least || (d == least && v < nearest)) nearest = v, least = d;
        }
      }
      report_.outlet_distance = std::max(report_.outlet_distance, least);
      vertices.push_back(nearest);
    }
    return vertices;
  }

  void fill(const Edges& edges, const Reaches& reaches) {
    std::vector<river::Link> links;
    for (const Reaches::Reach& r : reaches.reaches) links.push_back({r.from, r.to, r.length});
    const Hierarchy hierarchy = river::make_hierarchy(reaches.node.size(), links);
    for (river::Index v : reaches.node) result_.nodes_.push_back({edges.place(v), 0, 0});
    for (river::Index i = 0; i < links.size(); ++i) {
      const Reaches::Reach& r = reaches.reaches[i];
      ++result_.nodes_[r.from].out, ++result_.nodes_[r.to].in;
      result_.reaches_.push_back(
          {r.from, r.to, r.length, r.feature, hierarchy.sub_river[i], hierarchy.order[i], hierarchy.closes_cycle[i]});
      report_.cycle_reaches += hierarchy.closes_cycle[i] ? 1 : 0;
      result_.reach_begin_.push_back(river::Index(result_.points_.size()));
      for (std::size_t k = r.first; k < r.last; ++k) result_.points_.push_back(edges.place(reaches.chain[k]));
    }
    result_.reach_begin_.push_back(river::Index(result_.points_.size()));
    fill_sub_rivers(hierarchy);
    count_components(links);
  }

  void fill_sub_rivers(const Hierarchy& hierarchy) {
    for (river::Index s = 0; s < hierarchy.sub_rivers.size(); ++s) {
      const Hierarchy::SubRiver& from = hierarchy.sub_rivers[s];
      std::map<std::int64_t, double> share;
      for (river::Index r : from.links) share[result_.reaches_[r].feature] += result_.reaches_[r].length;
      const auto most = std::max_element(share.begin(), share.end(),
                                         [](const auto& a, const auto& b) { return a.second < b.second; });
      const RiverNetwork::Reach &first = result_.reaches_[from.links.front()],
                                &last = result_.reaches_[from.links.back()];
      RiverNetwork::SubRiver sub{first.from,   last.to,   from.length,    last.order,
                                 std::nullopt, from.stem, from.stem == s, most->first};
      if (from.downstream != Hierarchy::none) sub.downstream = from.downstream;
      result_.sub_rivers_.push_back(sub);
      report_.rivers += sub.is_stem ? 1 : 0;
      result_.member_begin_.push_back(river::Index(result_.member_.size()));
      result_.member_.insert(result_.member_.end(), from.links.begin(), from.links.end());
    }
    result_.member_begin_.push_back(river::Index(result_.member_.size()));
  }

  void count_components(const std::vector<river::Link>& links) {
    std::vector<river::Index> above(result_.nodes_.size());
    for (river::Index n = 0; n < above.size(); ++n) above[n] = n;
    const auto find = [&](river::Index n) {
      while (above[n] != n) n = above[n] = above[above[n]];
      return n;
    };
    report_.components = above.size();
    for (const river::Link& link : links) {
      const river::Index a = find(link.from), b = find(link.to);
      if (a == b) continue;
      above[a] = b;
      --report_.components;
    }
  }

  const Network& network_;
  const RiverOptions& options_;
  const Context& context_;
  RiverReport report_;
  RiverNetwork result_;
};

Result<RiverNetwork> RiverNetwork::build(const Network& network, const RiverOptions& options, const Context& context) {
  return RiverBuilder(network, options, context).run();
}

std::span<const RiverNetwork::Index> RiverNetwork::reaches_of(Index sub_river) const {
  return {member_.data() + member_begin_[sub_river], member_begin_[sub_river + 1] - member_begin_[sub_river]};
}

std::span<const Point> RiverNetwork::reach_line(Index reach) const {
  return {points_.data() + reach_begin_[reach], reach_begin_[reach + 1] - reach_begin_[reach]};
}

std::vector<Point> RiverNetwork::sub_river_line(Index sub_river) const {
  std::vector<Point> line;
  for (Index r : reaches_of(sub_river)) {
    const auto part = reach_line(r);
    line.insert(line.end(), part.begin() + (line.empty() ? 0 : 1), part.end());
  }
  return line;
}

Result<Network> RiverNetwork::network(std::span<const Index> sub_rivers, const Context& context) const {
  Network::Builder builder;
  for (Index s : sub_rivers) builder.add_line(sub_river_line(s), s);
  return std::move(builder).build(context);
}

}  // namespace krepl
