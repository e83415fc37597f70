#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "krepl/surface.hpp"

namespace krepl::test {

/// A small terrain and a radius, for tests; can be written down and read again as text.
struct SmallTerrain {
  using Triangle = std::array<Point3, 3>;

  bool is_grid = true;
  Terrain::Grid grid{2, 2, {0, 0}, 1, 1, Terrain::Split::rising};
  std::vector<double> heights;      ///< grids; NaN is a missing sample
  std::vector<Triangle> triangles;  ///< meshes
  double radius = 1;
};

/// Enough to repeat the case, in as few characters as small integers need:
///   grid COLUMNS ROWS rising|falling|shorter radius R, then the heights, a row of the grid a line from least y, "."
///   where missing; mesh radius R, then nine coordinates a line, a triangle each.
/// Grids have their first sample at the origin and cells of 1.
std::string text(const SmallTerrain& c);
inline std::ostream& operator<<(std::ostream& out, const SmallTerrain& c) { return out << text(c); }
/// Reads what text() wrote; lines that start with # are comments. Nothing if it is something else.
std::optional<SmallTerrain> parse_small_terrain(const std::string& text);

/// The same terrain as a set of triangles, in the coordinates of the case.
std::vector<SmallTerrain::Triangle> triangles_of(const SmallTerrain& c);
/// The terrain; null with an error if it has no triangle.
Result<std::shared_ptr<const Terrain>> terrain_of(const SmallTerrain& c);
/// The same case as a mesh.
SmallTerrain as_mesh(const SmallTerrain& c);

/// Kinds of random small terrains on whole numbers, where ties are the rule.
enum class SmallTerrainFamily : std::uint8_t {
  grid,       ///< few different heights
  steep,      ///< a grid with heights far above the cell size: nearly vertical faces
  holes,      ///< a grid with missing samples
  diagonals,  ///< a mesh over a grid, each cell split its own way
  steps,      ///< level cells with vertical walls between them
  soup,       ///< any triangles: overhangs, crossings, T-junctions, vertical ones
  count
};
const char* name(SmallTerrainFamily family);

/// Every sequence of bytes is a case; short ones are small. The first form takes the family from the first byte.
SmallTerrain decode_small_terrain(std::span<const std::uint8_t> bytes);
SmallTerrain decode_small_terrain(SmallTerrainFamily family, std::span<const std::uint8_t> bytes);

/// Smaller cases of the same kind, the smallest first: with a row, a column or a triangle less, or lower heights.
std::vector<SmallTerrain> smaller(const SmallTerrain& c);

}  // namespace krepl::test
