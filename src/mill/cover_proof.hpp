#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/drop_cutter.hpp"
#include "krepl/tool_path.hpp"
#include "mill/links.hpp"

namespace krepl::mill {

/// A straight piece of a path, of the ball's centre, relative to the part's origin.
struct PathPiece {
  Point3 from, to;
};

struct CoverOptions {
  double radius = 0;     ///< of the tool
  double allowance = 0;  ///< left everywhere on the part
  double height = 0;     ///< greatest height of what may be left above that, less than the radius
  double off = 0;        ///< how far the path may be from the pieces (chords of arcs)
  bool shank = false;    ///< what is beside and above the ball counts as taken off by its shank, as in passes along a wall's foot
  double smallest = 0;   ///< greatest side of the smallest cubes; 0: a fiftieth of half the distance of passes on a plane
};

/// Proves that a path leaves nothing higher than wanted above what its tool can reach, or tells where it may.
///
/// Let c be a place where the ball rests on the part, grown by the allowance A, and m a direction from a touched place to c
/// (where the ball touches several places, also those between). What the tool of radius r leaves below c reaches up to
/// x = c - (r - h) m at most, if x is within r of the path. So all such x are asked for: space is cut into cubes down to where
/// for every triangle that the ball may touch from inside of a cube one place a of the path is near enough to all of them.
///
/// With q0 the place of a triangle nearest to the middle c0 of a cube of half diagonal e, for other c in the cube the nearest
/// place q and the way c - q differ by no more than e, and q - q0 is orthogonal to the way but for e^2 / 2: projections onto
/// convex bodies are firmly nonexpansive. This is all the bounds need; nothing is sampled.
///
/// Triangles stand for all below them too, which is convex, so that walls below borders and overhangs count as others.
/// Vertical walls count where the ball rests on something at their foot. Places are looked at in tiles of the plane.
class CoverProof {
 public:
  /// `cutter`: of the tool's radius and the allowance.
  CoverProof(const DropCutter& cutter, const CoverOptions& options);

  void add(const PathPiece& piece);
  /// The pieces of a cut, chords of its arcs within options.off, or its one place; coordinates are absolute.
  void add(const Cut& cut);

  /// Side of the smallest cubes.
  double smallest_side() const { return std::ldexp(side_, -levels_); }

  std::size_t tile_count() const { return columns_ * rows_; }
  /// Looks at tiles; `open` becomes, tile by tile, places that are not covered, one of a cube of a quarter of the distance
  /// of passes at most, and the middles of the smallest cubes that are not proven, all relative to the part's origin;
  /// `open_tiles` the tiles that have some. `is_of_interest`, which may be empty, tells of a place whether anything within
  /// a distance of it in x and y is to be looked at; of the smallest cubes the middle counts. False if cancelled.
  bool run(const std::vector<std::size_t>& tiles, const std::function<bool(Point3, double)>& is_of_interest,
           const Context& context, std::vector<Point3>& open, std::vector<std::size_t>& open_tiles);
  std::vector<std::size_t> all_tiles() const;

 private:
  friend class CoverTile;
  void sort_pieces();

  const DropCutter& cutter_;
  DropCutter needle_;  // a ball so small that it rests on the part's upper side
  CoverOptions o_;
  double reach_ = 0;  // half of the distance of passes on a plane
  double side_ = 0;   // of tiles
  double tiny_ = 0;
  int levels_ = 0;    // of halving
  std::vector<DropCutter> smaller_, larger_;  // by e, for each level
  Point first_;
  std::size_t columns_ = 0, rows_ = 0;
  std::vector<PathPiece> pieces_;       // short ones
  std::vector<std::uint32_t> begin_;    // of pieces_, for each cell of a raster of bucket_
  std::size_t sorted_ = 0, across_ = 0, up_ = 0;
  double bucket_ = 0;
};

}  // namespace krepl::mill
