#pragma once

#include <cstdint>
#include <vector>

#include "view/surface/height_pyramid.hpp"
#include "view/surface/shape.hpp"

namespace krepl::view {

/// A shape cut into tiles by a quadtree of its bounding square: leaves have the faces whose middle lies in them, with
/// all their triangles and lines; the tiles above have samples of the heights.
class TileTree {
 public:
  /// A leaf has no more, unless a single face has.
  static constexpr std::size_t most_triangles = 3000;

  explicit TileTree(const Shape& shape);

  struct Tile {
    int depth;
    std::int64_t column, row;             ///< of its square, among 2^depth a side
    std::uint32_t first_child, children;  ///< none: a leaf
    std::uint32_t first, last;            ///< of order(): its faces
    Point3 low, high;                     ///< box of all its triangles
  };
  /// Breadth first: the first one is the whole shape, those of a tile are in one run.
  const std::vector<Tile>& tiles() const { return tiles_; }
  const std::vector<std::uint32_t>& order() const { return order_; }
  /// The lines of a leaf, by the face they go with.
  std::vector<std::uint32_t> lines_of(const Tile& leaf) const;

  Point low() const { return low_; }
  double side() const { return side_; }
  /// Levels of tiles above the leaves that have samples; deeper ones are never drawn themselves.
  int sampled_levels() const { return sampled_levels_; }

 private:
  void measure();
  void sort_faces();
  void split();
  void make_boxes();
  std::uint64_t triangles_in(std::uint32_t first, std::uint32_t last) const;

  const Shape& shape_;
  Point low_{};
  double side_ = 1;
  int sampled_levels_ = 0;
  std::vector<Tile> tiles_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint64_t> place_;              // along the Z-curve, by position in order_
  std::vector<std::uint64_t> running_;            // triangles before each position
  std::vector<std::uint32_t> line_begin_, line_;  // compressed rows: lines by face
};

}  // namespace krepl::view
