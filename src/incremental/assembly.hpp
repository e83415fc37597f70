#pragma once

#include <memory>

#include "incremental/compute_union.hpp"
#include "krepl/surface.hpp"

namespace krepl {

/// Makes a Surface of the map of the whole union. A friend of Surface.
class IncrementalAssembly {
 public:
  IncrementalAssembly(std::shared_ptr<const Terrain> terrain, double radius, const incremental::Parts& parts,
                      const incremental::PlanarMap& map)
      : parts_(parts), map_(map) {
    surface_.radius_ = radius;
    surface_.terrain_ = std::move(terrain);
  }

  Surface finish(const SurfaceCounters& counters);

 private:
  using Index = Surface::Index;
  static constexpr Index none = Surface::none;

  /// Arcs in a row without a vertex between them that means anything: half-edges of the map.
  using Chain = std::vector<Index>;

  bool goes_on(Index h) const;
  Chain chain_from(Index h) const;
  void add_edge(const Chain& chain);
  void link();
  void number_faces();
  Surface::Curve curve_of(const Surface::Edge& edge, const incremental::Arc& arc) const;

  const incremental::Parts& parts_;
  const incremental::PlanarMap& map_;
  Surface surface_;
  std::vector<Index> vertex_number_, half_edge_;  // of the map's, in the surface
  std::vector<Chain> chains_;                     // of the surface's edges
};

}  // namespace krepl
