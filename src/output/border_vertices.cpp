#include <algorithm>
#include <numeric>

#include "output/surface_mesh.hpp"
#include "output/surface_patch.hpp"

namespace krepl::output {

namespace {

using Index = BorderVertices::Index;

Index root(std::vector<Index>& parent, Index i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

BorderVertices::BorderVertices(const Surface& surface, const SurfaceEdges& edges)
    : surface_(surface), topology_(surface.subdivision()), edges_(edges) {
  join_corners();
  number_corners();
  number_inner();
}

/// Around a vertex, corners on the two sides of a seam or valley are one; on the two sides of a rim they differ in height,
/// unless the rim ends there and they are joined the other way around.
void BorderVertices::join_corners() {
  corner_.resize(topology_.half_edge_count());
  std::iota(corner_.begin(), corner_.end(), Index{0});
  for (Index h = 0; h < corner_.size(); ++h) {
    if (surface_.edge(Subdivision::edge(h)).kind == Surface::EdgeKind::rim) continue;
    const Index a = root(corner_, h), b = root(corner_, topology_.next[Subdivision::twin(h)]);
    corner_[std::max(a, b)] = std::min(a, b);
  }
  for (Index h = 0; h < corner_.size(); ++h) corner_[h] = root(corner_, h);
}

/// The highest of a vertex's corners has the height of the surface's vertex, the others are on their own patches.
void BorderVertices::number_corners() {
  const Index none = Surface::none;
  std::vector<double> height(corner_.size(), 0), highest(topology_.vertex_count, -1e300);
  std::vector<Index> number(corner_.size(), none);
  for (Index h = 0; h < corner_.size(); ++h) {
    const Surface::Index feature = surface_.face_feature(topology_.face[h]);
    if (corner_[h] != h || feature == Surface::none) continue;
    const Surface::Index v = topology_.origin[h];
    const Point3 p = surface_.vertex(v);
    height[h] = SurfacePatch(surface_.terrain(), feature, surface_.radius()).height(p.x, p.y);
    highest[v] = std::max(highest[v], height[h]);
  }
  for (Index h = 0; h < corner_.size(); ++h) {
    if (corner_[h] != h || surface_.face_feature(topology_.face[h]) == Surface::none) continue;
    const Surface::Index v = topology_.origin[h];
    Point3 p = surface_.vertex(v);
    if (height[h] < highest[v]) p.z = height[h];
    number[h] = Index(vertices_.size());
    vertices_.push_back(p);
  }
  for (Index& c : corner_) c = number[c];
}

void BorderVertices::number_inner() {
  inner_.resize(topology_.edge_count());
  foot_.assign(topology_.edge_count(), Surface::none);
  for (Index e = 0; e < inner_.size(); ++e) {
    const std::vector<Point3>& points = edges_.inner(e);
    inner_[e] = Index(vertices_.size());
    vertices_.insert(vertices_.end(), points.begin(), points.end());
    if (points.empty() || !SurfaceEdges::has_foot(surface_, e)) continue;
    const Index h = SurfaceEdges::is_foot(surface_, 2 * e) ? 2 * e : 2 * e + 1;
    const SurfacePatch patch(surface_.terrain(), surface_.face_feature(topology_.face[h]), surface_.radius());
    foot_[e] = Index(vertices_.size());
    for (const Point3 p : points) vertices_.push_back({p.x, p.y, patch.height(p.x, p.y)});
  }
}

std::vector<Index> BorderVertices::along(Surface::Index h) const {
  const Surface::Index e = Subdivision::edge(h);
  const std::size_t count = edges_.inner(e).size();
  std::vector<Index> result(count);
  std::iota(result.begin(), result.end(), SurfaceEdges::is_foot(surface_, h) ? foot_[e] : inner_[e]);
  if (h % 2 != 0) std::reverse(result.begin(), result.end());
  return result;
}

std::vector<Index> BorderVertices::loop(Surface::Index first) const {
  std::vector<Index> result;
  Surface::Index h = first;
  do {
    result.push_back(corner_[h]);
    for (const Index v : along(h)) result.push_back(v);
    h = topology_.next[h];
  } while (h != first);
  return result;
}

}  // namespace krepl::output
