#pragma once

#include <cstdint>
#include <vector>

#include "view/surface/height_pyramid.hpp"
#include "view/surface/tile_tree.hpp"

namespace krepl::view {

/// Tiles as bytes for the page, compressed by deflate (zlib). docs/view.md has the
/// formats; surface/page/decode.js reads them.
using TileBytes = std::vector<std::uint8_t>;

/// A leaf: vertices, faces with the features that the ball touches there, triangles, lines. Vertices of a surface are
/// whole numbers of 1/65535 of the tile's box; those of a terrain, and the points of features, are doubles.
TileBytes encode_leaf(const Shape& shape, const TileTree& tree, const TileTree::Tile& leaf);

/// Samples of a tile above the leaves: heights as whole numbers in its box, and shares of kinds, on a grid that is one
/// cell larger on each side.
TileBytes encode_samples(const HeightPyramid& pyramid, const TileTree::Tile& tile);

/// Adds arrays byte by byte of equal weight, so that what is alike comes together for compression. Exposed for tests.
class PlaneWriter {
 public:
  void bytes(const std::vector<std::uint8_t>& values);
  void words(const std::vector<std::uint32_t>& values);
  void doubles(const std::vector<double>& values);
  /// Compressed by zlib.
  TileBytes finish() const;

 private:
  template <class T>
  void planes(const std::vector<T>& values);
  std::vector<std::uint8_t> raw_;
};

}  // namespace krepl::view
