#pragma once

#include "terrain/tile.hpp"

namespace krepl {

/// Puts the tiles of a surface together. A friend of Surface.
class SurfaceAssembly {
 public:
  static Result<Surface> assemble(std::shared_ptr<const Terrain> terrain, double radius, const terrain::Tiling& tiling,
                                  std::vector<terrain::Tile> tiles, const SurfaceCounters& counters);

 private:
  SurfaceAssembly(const terrain::Tiling& tiling, std::vector<terrain::Tile> tiles, Surface& surface);
  using Index = Surface::Index;
  /// A chain of a tile, to be walked from its end `from`.
  struct Step {
    Index tile, chain;
    int from;
  };

  std::optional<Error> join_sides();
  void number_arms();
  void trace_edges();
  void trace(Step start);
  std::optional<Error> trace_faces();
  void collect_loops(std::vector<Index>& loop_face, std::vector<Index>& loop_start, std::vector<double>& loop_area) const;
  Index region(Index global);
  Error disagreement(Index tile, std::uint8_t side) const;

  const terrain::Tiling& tiling_;
  std::vector<terrain::Tile> tiles_;
  Surface& surface_;
  std::vector<Index> vertex_begin_, arm_begin_, region_begin_;  // per tile: numbers over all tiles
  std::vector<Index> region_;                                   // union-find
  std::vector<std::array<std::vector<Step>, 4>> side_chain_;     // per tile and side: the chain that ends at each crossing
  std::vector<std::vector<bool>> used_;                          // per tile and chain
  std::vector<Index> arm_half_edge_, half_edge_arm_;
};

}  // namespace krepl
