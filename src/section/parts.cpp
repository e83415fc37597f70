#include "section/parts.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernel/parallel.hpp"

namespace krepl::section {

namespace {

Index root(std::vector<Index>& parent, Index i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/// Half-edges that start where a rim does or ends, ascending.
std::vector<Index> half_edges_at_rims(const Surface& surface) {
  const Subdivision& topology = surface.subdivision();
  std::vector<bool> at_rim(topology.vertex_count);
  for (Index e = 0; e < topology.edge_count(); ++e) {
    if (surface.edge(e).kind != Surface::EdgeKind::rim) continue;
    at_rim[topology.origin[2 * e]] = at_rim[topology.origin[2 * e + 1]] = true;
  }
  std::vector<Index> result;
  for (Index h = 0; h < topology.half_edge_count(); ++h) {
    if (at_rim[topology.origin[h]]) result.push_back(h);
  }
  return result;
}

/// Around a vertex, corners on the two sides of a seam or valley are one. For each half-edge the place of the least one
/// of its corner.
std::vector<Index> join_corners(const Surface& surface, const std::vector<Index>& half_edges) {
  const Subdivision& topology = surface.subdivision();
  std::vector<Index> corner(half_edges.size());
  std::iota(corner.begin(), corner.end(), Index{0});
  for (Index i = 0; i < corner.size(); ++i) {
    const Index h = half_edges[i];
    if (surface.edge(Subdivision::edge(h)).kind == Surface::EdgeKind::rim) continue;
    const auto at = std::lower_bound(half_edges.begin(), half_edges.end(), topology.next[Subdivision::twin(h)]);
    const Index a = root(corner, i), b = root(corner, Index(at - half_edges.begin()));
    corner[std::max(a, b)] = std::min(a, b);
  }
  for (Index i = 0; i < corner.size(); ++i) corner[i] = root(corner, i);
  return corner;
}

}  // namespace

void Parts::Box::add(Point3 p) { add(Box{p, p}); }

void Parts::Box::add(const Box& b) {
  low = {std::min(low.x, b.low.x), std::min(low.y, b.low.y), std::min(low.z, b.low.z)};
  high = {std::max(high.x, b.high.x), std::max(high.y, b.high.y), std::max(high.z, b.high.z)};
}

void Parts::Box::widen(double by) {
  low = {low.x - by, low.y - by, low.z - by};
  high = {high.x + by, high.y + by, high.z + by};
}

Parts::Parts(std::shared_ptr<const Surface> s)
    : surface(std::move(s)), scale(std::max(surface->radius(), surface->terrain().extent())), shift(0x1p-40 * scale) {}

bool Parts::build(const Context& context) {
  find_lower_corners();
  return find_boxes(context) && find_domes(context);
}

/// The highest of a vertex's corners has the height of the surface's vertex, the others are on their own patches.
void Parts::find_lower_corners() {
  const std::vector<Index> half_edges = half_edges_at_rims(*surface);
  const std::vector<Index> corner = join_corners(*surface, half_edges);
  std::vector<double> height(corner.size(), -infinite);
  std::vector<std::pair<Index, double>> highest;  // per vertex
  for (Index i = 0; i < corner.size(); ++i) {
    const Index face = topology().face[half_edges[i]], v = topology().origin[half_edges[i]];
    if (corner[i] != i || surface->face_feature(face) == none) continue;
    const Point3 p = surface->vertex(v);
    height[i] = patch(face).height({p.x, p.y});
    highest.push_back({v, -height[i]});
  }
  std::sort(highest.begin(), highest.end());
  for (Index i = 0; i < corner.size(); ++i) {
    const Index v = topology().origin[half_edges[i]];
    const auto most = std::lower_bound(highest.begin(), highest.end(), std::pair{v, -infinite});
    const double z = surface->vertex(v).z, own = height[corner[i]];
    if (own == -most->second) continue;
    lower_corners.push_back({half_edges[i], std::min(own, z)});
  }
}

double Parts::corner_height(Index h) const {
  const auto at = std::lower_bound(lower_corners.begin(), lower_corners.end(), h,
                                   [](const LowerCorner& c, Index half_edge) { return c.half_edge < half_edge; });
  if (at != lower_corners.end() && at->half_edge == h) return at->height;
  return surface->vertex(topology().origin[h]).z;
}

Parts::Box Parts::edge_box(Index e) const {
  Box box;
  const Point3 a = surface->vertex(topology().origin[2 * e]), b = surface->vertex(topology().origin[2 * e + 1]);
  box.add(a);
  box.add(b);
  const Surface::Edge edge = surface->edge(e);
  const auto distance = [](Point3 p, Point3 q) { return std::hypot(p.x - q.x, p.y - q.y, p.z - q.z); };
  double bulge = shift;
  if (edge.curve != Surface::Curve::line) {
    // Between ends and guides a curve bends by less than half a circle, so half of the chord would do.
    const std::span<const Point3> guides = surface->guides(e);
    double longest = 0;
    Point3 last = a;
    for (const Point3 p : guides) {
      box.add(p);
      longest = std::max(longest, distance(last, p));
      last = p;
    }
    bulge += std::max(longest, distance(last, b));
  }
  box.widen(bulge);
  if (edge.kind == Surface::EdgeKind::rim)
    box.low.z = -infinite;
  else
    for (const Index h : {2 * e, 2 * e + 1}) box.low.z = std::min(box.low.z, corner_height(h) - bulge);
  return box;
}

bool Parts::find_boxes(const Context& context) {
  const std::size_t count = topology().edge_count();
  levels.emplace_back((count + arity - 1) / arity);
  constexpr std::size_t block = std::size_t{512} * arity;
  const bool done = kernel::parallel_blocks(context, count, block, [&](std::size_t first, std::size_t last) {
    for (std::size_t e = first; e < last; ++e) levels[0][e / arity].add(edge_box(Index(e)));
  });
  if (!done) return false;
  while (levels.back().size() > 1) {
    const auto& below = levels.back();
    std::vector<Box> level((below.size() + arity - 1) / arity);
    for (std::size_t i = 0; i < below.size(); ++i) level[i / arity].add(below[i]);
    levels.push_back(std::move(level));
  }
  return true;
}

bool Parts::face_holds(Index face, Point p) const {
  bool inside = false;
  const auto add_loop = [&](Index first) {
    Index h = first;
    do {
      std::vector<Point3> points = surface->curve(Subdivision::edge(h), 33);
      // Chords do where the place is not between one and its arc.
      const auto is_near = [&](Point3 q) {
        const double reach = std::hypot(points[0].x - points[1].x, points[0].y - points[1].y);
        return std::hypot(q.x - p.x, q.y - p.y) <= 2 * reach;
      };
      if (std::any_of(points.begin(), points.end(), is_near)) points = surface->curve(Subdivision::edge(h), 4097);
      for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const Point3 a = points[i], b = points[i + 1];
        if ((a.y > p.y) == (b.y > p.y)) continue;
        if (a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) > p.x) inside = !inside;
      }
    } while ((h = topology().next[h]) != first);
  };
  add_loop(topology().face_outer[face]);
  for (const Index h : topology().inner_loops(face)) add_loop(h);
  return inside;
}

std::optional<Parts::Dome> Parts::dome(Index face) const {
  const Index feature = surface->face_feature(face);
  if (feature == none || surface->terrain().feature_kind(feature) != Terrain::FeatureKind::vertex) return std::nullopt;
  const Point3 at = surface->terrain().corners(feature).point[0];
  const bool has_holes = !topology().inner_loops(face).empty();
  Box box;
  Index h = topology().face_outer[face];
  do box.add(edge_box(Subdivision::edge(h)));
  while ((h = topology().next[h]) != topology().face_outer[face]);
  const bool beside = at.x < box.low.x || at.x > box.high.x || at.y < box.low.y || at.y > box.high.y;
  const bool holds_top = !beside && face_holds(face, {at.x, at.y});
  if (!has_holes && !holds_top) return std::nullopt;
  return Dome{face, at.z, at.z + surface->radius(), holds_top};
}

bool Parts::find_domes(const Context& context) {
  constexpr std::size_t block = 1024;
  const std::size_t count = topology().face_count();
  std::vector<std::vector<Dome>> found((count + block - 1) / block);
  const bool done = kernel::parallel_blocks(context, count, block, [&](std::size_t first, std::size_t last) {
    for (std::size_t f = std::max<std::size_t>(first, 1); f < last; ++f) {
      if (const auto d = dome(Index(f))) found[first / block].push_back(*d);
    }
  });
  if (!done) return false;
  for (const auto& part : found) domes.insert(domes.end(), part.begin(), part.end());
  return true;
}

}  // namespace krepl::section
