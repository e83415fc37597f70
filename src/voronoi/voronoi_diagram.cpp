#include <algorithm>
#include <cmath>

#include "krepl/voronoi.hpp"
#include "voronoi/extract.hpp"
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

  Parts(std::shared_ptr<const Network> n, const Context& context) : network(std::move(n)), instance(*network, 0, 0, 1, context) {}

  Site site(Index element) const {
    if (instance.is_side(element)) return {false, element >> 1, element & 1u};
    return {true, instance.vertex_of(element), 0};
  }
};

Result<VoronoiDiagram> VoronoiDiagram::build(std::shared_ptr<const Network> network, const Context& context) {
  constexpr double largest_number = 1e18;
  if (network->extent() > largest_number) {
    return Error{ErrorCode::input, "coordinates are beyond 1e18", "", "scale the input"};
  }
  auto parts = std::make_shared<Parts>(std::move(network), context);
  const voronoi::Sites sites(parts->instance, context);
  const voronoi::SiteBoxes boxes(parts->instance, context);
  auto diagram = voronoi::build_diagram(sites, boxes, context);
  if (!diagram) return diagram.error();
  parts->diagram = std::move(*diagram);
  const auto& c = parts->diagram.counters;
  parts->counters = {c.faces, c.candidates, c.faces_in_quadruple, c.vertices_in_quadruple, c.rounds};
  return VoronoiDiagram(std::move(parts));
}

Result<Zone> VoronoiDiagram::zone(const ZoneOptions& options, const Context& context) const {
  const auto precision = zone::precision_for(network(), options.radius);
  if (!precision) return precision.error();
  const voronoi::Instance instance(parts_->instance, options.radius, precision->effective_radius, precision->resolution);
  return ZoneAssembly::finish(parts_->network, instance, voronoi::extract_rings(parts_->diagram, instance, context),
                              precision->resolution, {}, context);
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
      edges.push_back({parts_->site(f), parts_->site(other), absolute(start), absolute(end), d.clearance[start], d.clearance[end],
                       d.minimum[i], mixed && !own, own});
    }
  }
  return edges;
}

std::optional<std::string> VoronoiDiagram::validate() const { return voronoi::validate(parts_->diagram, parts_->instance); }

}  // namespace krepl
