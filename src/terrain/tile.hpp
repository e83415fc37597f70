#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "terrain/cells.hpp"

namespace krepl::terrain {

/// The plane cut into tiles of equal size that cover the domain and a margin beyond its rim.
struct Tiling {
  Point low, high;
  Index columns = 1, rows = 1;

  Box box(Index column, Index row) const { return {{x(column), y(row)}, {x(column + 1), y(row + 1)}}; }
  std::size_t count() const { return std::size_t{columns} * rows; }

 private:
  double x(Index i) const { return i == columns ? high.x : low.x + (high.x - low.x) * (double(i) / columns); }
  double y(Index i) const { return i == rows ? high.y : low.y + (high.y - low.y) * (double(i) / rows); }
};
Tiling tiling_for(const Terrain& terrain, double radius);

/// One end of a chain: an arm of a vertex, or the k-th crossing of one of the tile's sides.
struct ChainEnd {
  enum class Kind : std::uint8_t { arm, side, closed } kind;
  std::uint8_t side;  ///< bottom, right, top, left
  Index index;        ///< the arm, or k
};

/// A boundary curve within a tile.
struct Chain {
  ChainEnd end[2];
  Index region[2];           ///< left and right of it
  Index first_guide;         ///< points of the curve between its ends, in order
  std::uint8_t guide_count;
  std::uint8_t lower;        ///< the lower side of a rim, left 0 or right 1, where the ball does not touch; 2: none
  Surface::EdgeKind kind;
  Surface::Curve curve;
};

/// What is left of a tile once it is subdivided.
struct Tile {
  std::vector<Point3> vertices;
  std::vector<Index> arm_begin;        ///< per vertex and one more; arms are counter-clockwise
  std::vector<Chain> chains;
  std::vector<Point3> guides;
  std::vector<Index> region_feature;   ///< per region; none outside
  std::array<std::vector<Index>, 4> side_region;   ///< per stretch of each side: its region
  std::array<std::vector<double>, 4> side_crossing;  ///< where labels change along each side
  SurfaceCounters counters;
  std::optional<Point> failed_at;
};

/// Buffers for one thread.
class TileWorker {
 public:
  Tile compute(const Terrain& terrain, const Tiling& tiling, Index column, Index row, double radius, double scale,
               const Context& context);

 private:
  TerrainWindow window_;
  PatchSet<double> patches_;
  PatchSet<DoubleDouble> fine_patches_;
};

}  // namespace krepl::terrain
