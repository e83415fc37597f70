#include <algorithm>
#include <numeric>

#include "output/surface_mesh.hpp"
#include "output/surface_patch.hpp"
#include "output/surface_writers.hpp"

namespace krepl::output {

namespace {

using Index = BorderVertices::Index;

Index root(std::vector<Index>& parent, Index i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/// Half-edges that start where a rim does or ends, ascending.
std::vector<Surface::Index> half_edges_at_rims(const Surface& surface) {
  const Subdivision& topology = surface.subdivision();
  std::vector<bool> at_rim(topology.vertex_count);
  for (Surface::Index h = 0; h < topology.half_edge_count(); ++h)
    if (surface.edge(Subdivision::edge(h)).kind == Surface::EdgeKind::rim) at_rim[topology.origin[h]] = true;
  std::vector<Surface::Index> result;
  for (Surface::Index h = 0; h < topology.half_edge_count(); ++h)
    if (at_rim[topology.origin[h]]) result.push_back(h);
  return result;
}

/// Around a vertex, corners on the two sides of a seam or valley are one; on the two sides of a rim they differ in
/// height, unless the rim ends there and they are joined the other way around. For each half-edge the place of the
/// least one of its corner.
std::vector<Index> join_corners(const Surface& surface, const std::vector<Surface::Index>& half_edges) {
  const Subdivision& topology = surface.subdivision();
  std::vector<Index> corner(half_edges.size());
  std::iota(corner.begin(), corner.end(), Index{0});
  for (Index i = 0; i < corner.size(); ++i) {
    const Surface::Index h = half_edges[i];
    if (surface.edge(Subdivision::edge(h)).kind == Surface::EdgeKind::rim) continue;
    const Surface::Index other = topology.next[Subdivision::twin(h)];
    const auto at = std::lower_bound(half_edges.begin(), half_edges.end(), other);
    const Index a = root(corner, i), b = root(corner, Index(at - half_edges.begin()));
    corner[std::max(a, b)] = std::min(a, b);
  }
  for (Index i = 0; i < corner.size(); ++i) corner[i] = root(corner, i);
  return corner;
}

}  // namespace

BorderVertices::BorderVertices(const Surface& surface, SurfaceEdges edges)
    : surface_(&surface), topology_(&surface.subdivision()), edges_(std::move(edges)) {
  number_corners();
}

Result<BorderVertices> BorderVertices::make(const Surface& surface, double max_error, const Context& context) {
  Result<SurfaceEdges> edges = SurfaceEdges::make(surface, max_error, context);
  if (!edges) return edges.error();
  BorderVertices border(surface, std::move(*edges));
  if (Status checked = border.check_count(); !checked) return checked.error();
  return border;
}

Status BorderVertices::refine(std::span<const Surface::Index> edges, double max_error, const Context& context) {
  if (Status refined = edges_.refine(edges, max_error, context); !refined) return refined;
  return check_count();
}

Status BorderVertices::check_count() const {
  if (std::uint64_t{first_inner()} + edges_.count() >= Surface::none) return too_many_vertices();
  return std::monostate{};
}

/// The highest of a vertex's corners has the height of the surface's vertex, the others are on their own patches.
void BorderVertices::number_corners() {
  const std::vector<Surface::Index> half_edges = half_edges_at_rims(*surface_);
  const std::vector<Index> corner = join_corners(*surface_, half_edges);
  struct Corner {
    Surface::Index vertex;
    double height;
    Index least;
  };
  std::vector<Corner> corners;
  for (Index i = 0; i < corner.size(); ++i) {
    const Surface::Index feature = surface_->face_feature(topology_->face[half_edges[i]]);
    if (corner[i] != i || feature == Surface::none) continue;
    const Surface::Index v = topology_->origin[half_edges[i]];
    const Point3 p = surface_->vertex(v);
    corners.push_back({v, SurfacePatch(surface_->terrain(), feature, surface_->radius()).height(p.x, p.y), i});
  }
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    if (a.vertex != b.vertex) return a.vertex < b.vertex;
    return a.height != b.height ? a.height > b.height : a.least < b.least;
  });
  std::vector<Index> number(corner.size(), Surface::none);
  double highest = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto& [v, height, least] = corners[i];
    if (i == 0 || corners[i - 1].vertex != v) {
      highest = height;
      continue;
    }
    number[least] = first_inner();
    lower_.push_back(surface_->vertex(v));
    if (height < highest) lower_.back().z = height;
  }
  for (Index i = 0; i < corner.size(); ++i)
    if (number[corner[i]] != Surface::none) lower_corner_.push_back({half_edges[i], number[corner[i]]});
}

Index BorderVertices::corner(Surface::Index h) const {
  const auto at = std::lower_bound(
      lower_corner_.begin(), lower_corner_.end(), h,
      [](const LowerCorner& corner, Surface::Index half_edge) { return corner.half_edge < half_edge; });
  return at != lower_corner_.end() && at->half_edge == h ? at->vertex : topology_->origin[h];
}

Point3 BorderVertices::vertex(Index v) const {
  if (v < topology_->vertex_count) return surface_->vertex(v);
  return v < first_inner() ? lower_[v - topology_->vertex_count] : edges_.point(v - first_inner());
}

void BorderVertices::append(Surface::Index h, std::vector<Index>& vertices) const {
  vertices.push_back(corner(h));
  const Surface::Index e = Subdivision::edge(h);
  const std::size_t count = edges_.inner(e).size(), first = vertices.size();
  vertices.resize(first + count);
  Index number = first_inner() + edges_.first(e);
  if (SurfaceEdges::is_foot(*surface_, h)) number += Index(count);
  std::iota(vertices.begin() + std::ptrdiff_t(first), vertices.end(), number);
  if (h % 2 != 0) std::reverse(vertices.begin() + std::ptrdiff_t(first), vertices.end());
}

std::vector<Index> BorderVertices::loop(Surface::Index first) const {
  std::vector<Index> result;
  Surface::Index h = first;
  do append(h, result);
  while ((h = topology_->next[h]) != first);
  return result;
}

bool BorderVertices::has_triangles(Surface::Index f) const {
  if (surface_->face_feature(f) == Surface::none) return false;
  if (!topology_->inner_loops(f).empty()) return true;
  const Surface::Index first = topology_->face_outer[f];
  std::size_t count = 0;
  Surface::Index h = first;
  do count += 1 + edges_.inner(Subdivision::edge(h)).size();
  while (count < 3 && (h = topology_->next[h]) != first);
  return count >= 3;
}

}  // namespace krepl::output
