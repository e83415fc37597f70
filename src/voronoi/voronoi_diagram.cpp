#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "kernel/parallel.hpp"
#include "krepl/voronoi.hpp"
#include "voronoi/bisector.hpp"
#include "voronoi/extract.hpp"
#include "voronoi/owner_lobes.hpp"
#include "voronoi/owner_zones.hpp"
#include "zone/assembly.hpp"
#include "zone/precision.hpp"

namespace krepl {

using voronoi::Index;
using voronoi::none;

struct VoronoiDiagram::Parts {
  std::shared_ptr<const Network> network;
  voronoi::Instance instance;
  voronoi::Diagram diagram;
  VoronoiCounters counters;

  Parts(std::shared_ptr<const Network> n, const Context& context)
      : network(std::move(n)), instance(*network, 0, 0, 1, context) {}

  Site site(Index element) const {
    if (instance.is_side(element)) return {false, element >> 1, element & 1u};
    return {true, instance.vertex_of(element), 0};
  }
};

bool diagram_pays(const Network& network, std::span<const double> radii) {
  constexpr std::size_t many = 16;
  return radii.size() >= many && *std::max_element(radii.begin(), radii.end()) < network.extent();
}

std::uint64_t diagram_budget(const Network& network, std::size_t radii) {
  constexpr std::uint64_t each = 64;  // take as long as a sweep takes for a segment
  return each * std::max<std::uint64_t>(radii, 1) * (network.segments().size() + network.vertices().size());
}

Result<VoronoiDiagram> VoronoiDiagram::build(std::shared_ptr<const Network> network, const Context& context,
                                             const VoronoiOptions& options) {
  constexpr double largest_number = 1e18;
  if (network->extent() > largest_number) {
    return Error{ErrorCode::input, "coordinates are beyond 1e18", "", "scale the input"};
  }
  auto parts = std::make_shared<Parts>(std::move(network), context);
  const voronoi::Sites sites(parts->instance, context);
  const voronoi::SiteBoxes boxes(parts->instance, context);
  auto diagram = voronoi::build_diagram(sites, boxes, options.most_candidates, context);
  if (!diagram) return diagram.error();
  parts->diagram = std::move(*diagram);
  const auto& c = parts->diagram.counters;
  parts->counters = {
      c.faces,           c.candidates,       c.faces_in_pairs, c.faces_in_quadruple, c.vertices_in_quadruple,
      c.faces_in_widest, c.links_reconciled, c.rounds};
  return VoronoiDiagram(std::move(parts));
}

namespace {

Result<zone::Precision> precision_within(const Network& network, double radius, double horizon) {
  const auto precision = zone::precision_for(network, radius);
  if (precision && radius >= horizon) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", radius);
    return Error{ErrorCode::usage, "the radius " + std::string(text) + " is beyond the horizon of the Voronoi diagram",
                 "", "take the engine intervals"};
  }
  return precision;
}

}  // namespace

Result<std::vector<OwnerZone>> VoronoiDiagram::owner_zones(double radius, std::span<const std::uint32_t> part_owner,
                                                           double max_error, const Context& context) const {
  if (part_owner.size() != network().part_count()) {
    return Error{ErrorCode::usage,
                 "there are " + std::to_string(part_owner.size()) + " owners for " +
                     std::to_string(network().part_count()) + " parts",
                 "", "give one owner for each part"};
  }
  if (!(max_error > 0)) return Error{ErrorCode::usage, "the largest error of chords is not positive", "", ""};
  const auto precision = precision_within(network(), radius, horizon());
  if (!precision) return precision.error();
  const voronoi::Instance instance(parts_->instance, radius, precision->effective_radius, precision->resolution);
  voronoi::OwnerLobes lobes(parts_->diagram, instance);
  if (Status found = lobes.find(network(), part_owner); !found) return found.error();
  return voronoi::owner_zones(network(), parts_->diagram, instance, lobes, {max_error, precision->resolution}, context);
}

Result<Zone> VoronoiDiagram::zone(const ZoneOptions& options, const Context& context) const {
  const auto precision = precision_within(network(), options.radius, horizon());
  if (!precision) return precision.error();
  const voronoi::Instance instance(parts_->instance, options.radius, precision->effective_radius,
                                   precision->resolution);
  auto rings = voronoi::extract_rings(parts_->diagram, instance, context);
  if (!rings) return rings.error();
  return ZoneAssembly::finish(parts_->network, instance, std::move(*rings), precision->resolution, {}, context);
}

Result<std::vector<Zone>> VoronoiDiagram::zones(std::span<const double> radii, const Context& context) const {
  std::vector<std::optional<Result<Zone>>> found(radii.size());
  kernel::Progress progress(context, radii.size());
  Context alone;
  alone.threads = 1;
  alone.cancel = context.cancel;
  // Few radii leave threads without work, so then they share each.
  const bool few = radii.size() < 4;
  Context outside = context;
  if (few) outside.threads = 1, alone.threads = context.threads;
  const bool done = kernel::parallel_blocks(outside, radii.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) found[i].emplace(zone({radii[i]}, alone));
    progress.add(last - first);
  });
  if (!done || context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  std::vector<Zone> zones;
  zones.reserve(radii.size());
  for (auto& result : found) {
    if (!*result) return result->error();
    zones.push_back(std::move(**result));
  }
  return zones;
}

double VoronoiDiagram::horizon() const {
  return network().extent() > 0 ? voronoi::horizon_in_extents * network().extent()
                                : std::numeric_limits<double>::infinity();
}

const Network& VoronoiDiagram::network() const { return *parts_->network; }
const VoronoiCounters& VoronoiDiagram::counters() const { return parts_->counters; }
std::size_t VoronoiDiagram::face_count() const { return parts_->counters.faces; }
std::size_t VoronoiDiagram::vertex_count() const { return parts_->diagram.place.size(); }
std::size_t VoronoiDiagram::edge_count() const {
  const auto& twin = parts_->diagram.twin;
  return std::size_t(twin.size() - std::size_t(std::count(twin.begin(), twin.end(), none))) / 2;
}

std::vector<VoronoiDiagram::Edge> VoronoiDiagram::edges() const {
  const voronoi::Diagram& d = parts_->diagram;
  const voronoi::Instance& in = parts_->instance;
  const Point origin = network().origin();
  const auto absolute = [&](Index vertex) { return Point{d.place[vertex].x + origin.x, d.place[vertex].y + origin.y}; };
  std::vector<Edge> edges;
  edges.reserve(edge_count());
  for (Index f = 0; f < d.face_count(); ++f) {
    for (Index i = d.begin[f]; i < d.begin[f + 1]; ++i) {
      const Index other = d.label[i];
      if (d.twin[i] == none || other < f) continue;
      const Index start = d.vertex[d.twin[i]], end = d.vertex[i];
      const bool mixed = in.is_side(f) != in.is_side(other);
      bool own = false;
      if (mixed) {
        const auto e = in.ends(in.is_side(f) ? f : other);
        const Index v = in.vertex_of(in.is_side(f) ? other : f);
        own = e.from == v || e.to == v;
      }
      edges.push_back({parts_->site(f), parts_->site(other), absolute(start), absolute(end), d.clearance[start],
                       d.clearance[end], d.minimum[i], mixed && !own, own});
    }
  }
  return edges;
}

std::vector<Point> VoronoiDiagram::points(const Edge& edge, double max_error, double max_clearance) const {
  const Point o = network().origin();
  const auto local = [&](Point p) { return Point{p.x - o.x, p.y - o.y}; };
  const voronoi::Bisector bisector(network(), edge, local(edge.start), local(edge.end));
  std::vector<Point> points = bisector.points(max_error, max_clearance);
  for (Point& p : points) p = {p.x + o.x, p.y + o.y};
  return points;
}

std::optional<Point> VoronoiDiagram::control_point(const Edge& edge, double max_clearance) const {
  const Point o = network().origin();
  const voronoi::Bisector bisector(network(), edge, {edge.start.x - o.x, edge.start.y - o.y},
                                   {edge.end.x - o.x, edge.end.y - o.y});
  const std::optional<Point> p = bisector.control_point(max_clearance);
  return p ? std::optional(Point{p->x + o.x, p->y + o.y}) : std::nullopt;
}

std::optional<std::string> VoronoiDiagram::validate() const {
  return voronoi::validate(parts_->diagram, network().extent() > 0 ? horizon() : 0);
}

}  // namespace krepl
