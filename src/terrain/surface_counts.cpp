#include "terrain/surface_counts.hpp"

#include <algorithm>

namespace krepl::terrain {

SurfaceCounts count_surface(const Surface& surface) {
  using Index = Surface::Index;
  const Subdivision& topology = surface.subdivision();
  SurfaceCounts counts;
  counts.vertices = topology.vertex_count, counts.edges = topology.edge_count(), counts.faces = topology.face_count();
  std::vector<std::uint8_t> valleys_at(topology.vertex_count, 0);  // three are enough
  for (std::size_t e = 0; e < topology.edge_count(); ++e) {
    const Surface::EdgeKind kind = surface.edge(Index(e)).kind;
    ++(kind == Surface::EdgeKind::seam     ? counts.seams
       : kind == Surface::EdgeKind::valley ? counts.valleys
                                           : counts.rims);
    if (kind != Surface::EdgeKind::valley) continue;
    for (const std::size_t h : {2 * e, 2 * e + 1}) {
      std::uint8_t& count = valleys_at[topology.origin[h]];
      count = std::min<std::uint8_t>(std::uint8_t(count + 1), 3);
    }
  }
  counts.triple_contacts = std::size_t(std::count(valleys_at.begin(), valleys_at.end(), 3));
  for (std::size_t f = 0; f < topology.face_count(); ++f) {
    const Index feature = surface.face_feature(Index(f));
    if (feature == Surface::none) continue;
    const Terrain::FeatureKind kind = surface.terrain().feature_kind(feature);
    ++(kind == Terrain::FeatureKind::face   ? counts.planes
       : kind == Terrain::FeatureKind::edge ? counts.cylinders
                                            : counts.spheres);
  }
  return counts;
}

}  // namespace krepl::terrain
