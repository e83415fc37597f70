#pragma once

#include "terrain/tile.hpp"

namespace krepl {

/// Puts the tiles of a surface together as they come, row by row, and keeps of them only what the surface is made of and what
/// still goes on beyond the tiles seen so far. A friend of Surface.
class SurfaceAssembly {
 public:
  SurfaceAssembly(std::shared_ptr<const Terrain> terrain, double radius, const terrain::Tiling& tiling);

  /// Takes the next tile. Errors: it sees a side otherwise than its neighbour.
  std::optional<Error> add(terrain::Tile tile);
  /// After the last tile.
  Surface finish();

 private:
  using Index = Surface::Index;
  static constexpr Index none = Surface::none;

  /// A vertex of which not all half-edges are known yet, or one place around it.
  struct OpenVertex {
    Index vertex, unknown;
    std::vector<Index> half_edge;  // counter-clockwise
  };
  struct Arm {
    Index open_vertex = none, place = 0;
  };
  /// Part of an edge: its ends are arms, or crossings of sides beyond which the tile is not there yet.
  struct Strand {
    std::uint8_t style;
    Index region[2];  // left and right on the way from end 0 to end 1
    Arm arm[2];
    std::vector<Point3> guides;
    // Once it has become part of another strand: the end of that which its own last open end has become.
    Index merged_strand = none;
    int merged_end = 0;
  };
  struct StrandEnd {
    Index strand = none;
    int end = 0;
  };
  /// A side of a tile whose other side is still to come.
  struct OpenSide {
    std::vector<double> crossing;
    std::vector<Index> region;
    std::vector<StrandEnd> strand;
  };
  /// What is known of a tile's arms while it is added.
  struct TileArms {
    std::vector<Index> half_edge;  // none: not yet
    std::vector<Arm> open;
  };

  void make_room(const terrain::Tile& tile);
  void add_inner_edges(const terrain::Tile& tile, TileArms& arms);
  void connect_vertices(const terrain::Tile& tile, TileArms& arms);
  void add_strands(const terrain::Tile& tile, const TileArms& arms, std::array<OpenSide, 4>& sides);
  bool join(OpenSide& earlier, OpenSide& later);
  void join(StrandEnd earlier, StrandEnd later);
  StrandEnd current(StrandEnd end);
  void emit(Index strand);
  void emit_closed(Index strand);
  Index add_edge(std::uint8_t style, Index left, Index right, Index from, Index to);
  void add_guides(const Point3* first, std::size_t count);
  void attach(Arm arm, Index half_edge);
  void connect(const std::vector<Index>& around);
  Index region(Index r);
  void number_faces();
  void list_loops();
  double loop_area(Index h) const;
  Error disagreement(std::uint8_t side) const;

  const terrain::Tiling tiling_;
  Surface surface_;
  std::size_t tiles_ = 0;  // added
  // Union-find over the regions of all tiles, whose features are in face_feature_ until faces have numbers.
  std::vector<Index> region_;
  std::vector<OpenVertex> open_vertex_;
  std::vector<Index> free_open_vertex_;
  std::vector<Strand> strand_;
  std::vector<Index> free_strand_;
  OpenSide right_;             // of the tile before
  std::vector<OpenSide> top_;  // per column, of the last tile there
};

}  // namespace krepl
