#include "route/axis.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <queue>

#include "krepl/voronoi.hpp"
#include "model/radius_check.hpp"
#include "route/axis_edge.hpp"
#include "route/ends.hpp"
#include "route/free_space.hpp"
#include "route/shortest.hpp"

namespace krepl::route {
namespace {

using Index = std::uint32_t;
constexpr double unlimited = std::numeric_limits<double>::infinity();

/// The obstacles' lines, in coordinates relative to their origin, and a frame about them and the ends. Without a frame
/// the axis would lead to infinity.
Result<Network> with_frame(const Network& network, double radius, Point from, Point to, const Context& context) {
  Network::Builder builder;
  Box box;
  box.add(from), box.add(to);
  std::vector<Point> points;
  for (Index part = 0; part < network.part_count(); ++part) {
    points.clear();
    for (Index v : network.part(part)) points.push_back(network.vertices()[v]), box.add(points.back());
    if (network.part_is_ring(part)) points.push_back(points.front());
    builder.add_line(points);
  }
  const double away = std::max({box.max_x - box.min_x, box.max_y - box.min_y, 4 * radius});
  const Point low{box.min_x - away, box.min_y - away}, high{box.max_x + away, box.max_y + away};
  const std::array<Point, 5> frame{low, {high.x, low.y}, high, {low.x, high.y}, low};
  builder.add_line(frame);
  return std::move(builder).build(context);
}

/// Where a place's largest empty disk that touches its nearest obstacle is centred: straight away from that obstacle,
/// as far as nothing else is nearer.
struct Access {
  Point place;
  double clearance;
};
Access climb_to_axis(const Obstacles& framed, Point p) {
  const Obstacles::Nearest nearest = framed.nearest(p);
  const Point foot = nearest.at, n = (1 / nearest.distance) * (p - foot);
  const Network& network = framed.network();
  const auto vertices = network.vertices();
  double least = unlimited;
  const auto meet_point = [&](Point e) {
    const double forward = dot(n, e - foot);
    if (forward > 0) least = std::min(least, dot(e - foot, e - foot) / (2 * forward));
  };
  for (const Network::Segment& s : network.segments()) {
    const Point a = vertices[s.a], b = vertices[s.b];
    if (distance_to_segment(foot, a, b) <= 0x1p-40 * network.extent()) continue;  // what the disk hangs on
    meet_point(a), meet_point(b);
    const Point d = b - a, m = (1 / length(d)) * right(d);
    for (const double side : {1.0, -1.0}) {  // side * m . (foot + t n - a) = t
      const double t = side * dot(m, foot - a) / (1 - side * dot(m, n));
      if (!(t > 0) || !std::isfinite(t)) continue;
      const double along = dot(foot + t * n - a, d);
      if (along >= 0 && along <= dot(d, d)) least = std::min(least, t);
    }
  }
  for (const Point v : vertices)  // isolated ones; others have been met
    if (distance(v, foot) > 0x1p-40 * network.extent()) meet_point(v);
  least = std::max(least, nearest.distance);
  return {foot + least * n, least};
}

/// The axis as a graph: its vertices, the accesses of the two ends, and the stretches between them.
class AxisGraph {
 public:
  struct Stretch {
    Index edge, a, b;
    double t0, t1, length, clearance;
  };

  AxisGraph(const VoronoiDiagram& diagram, const Access& first, const Access& last) {
    for (const VoronoiDiagram::Edge& e : diagram.edges())
      if (!e.touches_site) edges_.emplace_back(e, diagram.network());
    // The ends' nodes come first: 0 and 1.
    node_count_ = 2;
    const std::array<const Access*, 2> access{&first, &last};
    std::array<Index, 2> on{};
    for (int end = 0; end < 2; ++end) {
      double best = unlimited;
      for (Index e = 0; e < edges_.size(); ++e) {
        const double r = edges_[e].residual(access[std::size_t(end)]->place);
        if (r < best) best = r, on[std::size_t(end)] = e;
      }
      access_residual_ = std::max(access_residual_, best);
    }
    for (Index e = 0; e < edges_.size(); ++e) {
      std::vector<std::pair<double, Index>> cuts{{edges_[e].start(), node(edges_[e].place(edges_[e].start()))},
                                                 {edges_[e].end(), node(edges_[e].place(edges_[e].end()))}};
      for (Index end = 0; end < 2; ++end)
        if (on[end] == e) cuts.push_back({edges_[e].parameter(access[end]->place), end});
      const bool rises = edges_[e].start() <= edges_[e].end();
      std::stable_sort(cuts.begin(), cuts.end(),
                       [&](const auto& a, const auto& b) { return rises ? a.first < b.first : a.first > b.first; });
      for (std::size_t i = 0; i + 1 < cuts.size(); ++i) add(e, cuts[i], cuts[i + 1]);
    }
  }

  const AxisEdge& edge(Index e) const { return edges_[e]; }
  double access_residual() const { return access_residual_; }

  /// The largest clearance that still lets 0 and 1 be connected; nothing if they are not.
  std::optional<double> bottleneck() const {
    std::vector<Index> order(stretches_.size()), parent(node_count_);
    std::iota(order.begin(), order.end(), 0), std::iota(parent.begin(), parent.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return stretches_[a].clearance > stretches_[b].clearance; });
    const auto find = [&](Index n) {
      while (parent[n] != n) n = parent[n] = parent[parent[n]];
      return n;
    };
    for (Index i : order) {
      parent[find(stretches_[i].a)] = find(stretches_[i].b);
      if (find(0) == find(1)) return stretches_[i].clearance;
    }
    return std::nullopt;
  }

  /// The shortest way from 0 to 1 over stretches of at least a clearance: stretches, each with the sense it is run
  /// through.
  std::vector<std::pair<Stretch, bool>> shortest(double clearance) const {
    std::vector<std::vector<Index>> around(node_count_);
    for (Index i = 0; i < stretches_.size(); ++i) {
      if (stretches_[i].clearance < clearance) continue;
      around[stretches_[i].a].push_back(i), around[stretches_[i].b].push_back(i);
    }
    std::vector<double> cost(node_count_, unlimited);
    std::vector<Index> by(node_count_, Route::none);
    using Waiting = std::pair<double, Index>;
    std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> queue;
    cost[0] = 0, queue.push({0, 0});
    while (!queue.empty()) {
      const auto [c, n] = queue.top();
      queue.pop();
      if (c > cost[n]) continue;
      for (Index i : around[n]) {
        const Index other = stretches_[i].a == n ? stretches_[i].b : stretches_[i].a;
        if (!(c + stretches_[i].length < cost[other])) continue;
        cost[other] = c + stretches_[i].length, by[other] = i;
        queue.push({cost[other], other});
      }
    }
    std::vector<std::pair<Stretch, bool>> way;
    for (Index n = 1; n != 0 && by[n] != Route::none;) {
      const Stretch& s = stretches_[by[n]];
      way.push_back({s, s.b == n});
      n = s.b == n ? s.a : s.b;
    }
    std::reverse(way.begin(), way.end());
    return way;
  }

 private:
  Index node(Point p) {
    const auto [at, made] = nodes_.try_emplace({p.x, p.y}, node_count_);
    if (made) ++node_count_;
    return at->second;
  }
  void add(Index e, std::pair<double, Index> from, std::pair<double, Index> to) {
    stretches_.push_back({e, from.second, to.second, from.first, to.first, edges_[e].length(from.first, to.first),
                          edges_[e].clearance(from.first, to.first)});
  }

  std::vector<AxisEdge> edges_;
  std::map<std::pair<double, double>, Index> nodes_;
  Index node_count_ = 0;
  std::vector<Stretch> stretches_;
  double access_residual_ = 0;
};

Route::Piece axis_piece(const Network& network, const Obstacles& obstacles, const Network& framed, const AxisEdge& edge,
                        double t0, double t1) {
  if (edge.kind() == Route::Kind::line) return line_piece(obstacles, edge.place(t0), edge.place(t1));
  Route::Piece piece;
  piece.kind = Route::Kind::parabola;
  piece.start = edge.place(t0), piece.end = edge.place(t1);
  piece.center = edge.focus(), piece.control = edge.control(t0, t1);
  piece.length = edge.length(t0, t1), piece.clearance = edge.clearance(t0, t1);
  // Numbers of the framed network are others; those of the frame itself have no counterpart.
  const auto same = [&](Index v) {
    const Point p = framed.vertices()[v] + framed.origin();
    const auto found = std::find(network.vertices().begin(), network.vertices().end(), p);
    return found == network.vertices().end() ? Route::none : Index(found - network.vertices().begin());
  };
  piece.vertex = same(edge.focus_vertex());
  const Network::Segment s = framed.segments()[edge.directrix()];
  Network::Segment wanted{same(s.a), same(s.b)};
  if (wanted.a > wanted.b) std::swap(wanted.a, wanted.b);
  const auto found = std::find(network.segments().begin(), network.segments().end(), wanted);
  if (found != network.segments().end()) piece.segment = Index(found - network.segments().begin());
  return piece;
}

}  // namespace

Result<AxisRoute> widest_on_axis(const Network& network, const Obstacles& obstacles, double radius, Point from,
                                 Point to, const Context& context) {
  Result<Network> made = with_frame(network, radius, from, to, context);
  if (!made) return made.error();
  const auto framed = std::make_shared<const Network>(std::move(*made));
  Result<VoronoiDiagram> diagram = VoronoiDiagram::build(framed, context);
  if (!diagram) return diagram.error();
  const double tolerance = slack_for(network, radius).tolerance;
  // The framed network has an origin of its own.
  const Point origin = framed->origin();
  const Obstacles all(*framed);
  Access first = climb_to_axis(all, from - origin), last = climb_to_axis(all, to - origin);
  first.place = first.place + origin, last.place = last.place + origin;
  const AxisGraph graph(*diagram, first, last);
  const auto clearance = graph.bottleneck();
  if (!clearance || *clearance < radius - tolerance || graph.access_residual() > 1e-6 * framed->extent())
    return Error{ErrorCode::input,
                 "no route: a disk of radius " + shown(radius) + " cannot get from " + place_text(network, from) +
                     " to " + place_text(network, to) +
                     " along the medial axis: they are in different parts of free space",
                 "", "choose both ends in one part, or use a smaller radius"};
  AxisRoute route{*clearance, first.place, last.place, {}};
  for (const auto& [s, forward] : graph.shortest(*clearance)) {
    const AxisEdge& edge = graph.edge(s.edge);
    if (s.t0 == s.t1) continue;
    route.pieces.push_back(axis_piece(network, obstacles, *framed, edge, forward ? s.t0 : s.t1, forward ? s.t1 : s.t0));
  }
  if (!route.pieces.empty()) route.first = route.pieces.front().start, route.last = route.pieces.back().end;
  return route;
}

Result<Route> axis_route(const Network& network, const Obstacles& obstacles, double radius, Point from, Point to,
                         const Context& context) {
  Result<AxisRoute> axis = widest_on_axis(network, obstacles, radius, from, to, context);
  if (!axis) return axis.error();
  Route route;
  route.widest = axis->clearance;
  if (from != axis->first) route.pieces.push_back(line_piece(obstacles, from, axis->first));
  route.pieces.insert(route.pieces.end(), axis->pieces.begin(), axis->pieces.end());
  if (axis->last != to || route.pieces.empty()) route.pieces.push_back(line_piece(obstacles, axis->last, to));
  return route;
}

Point climb_to(const Obstacles& obstacles, Point end, double clearance, Point on_axis) {
  const Obstacles::Nearest nearest = obstacles.nearest(end);
  if (nearest.distance >= clearance || !(nearest.distance > 0)) return end;
  const Point n = (1 / nearest.distance) * (end - nearest.at);
  const double reach = distance(on_axis, nearest.at);
  return nearest.at + std::min(clearance, reach) * n;
}

}  // namespace krepl::route
