#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "krepl/point.hpp"

namespace krepl::output {

/// Cuts a polygon with holes into triangles that have only its own vertices, by clipping ears.
///
/// Every side of the polygon is a side of exactly one triangle, whatever the input: the triangles of neighbouring polygons fit
/// together. They cover the polygon without overlaps if it is simple; a polygon that crosses itself gets some triangles
/// that run clockwise or overlap, and says so. Decisions are exact. Expected time O(n), with holes O(n (1 + holes)).
class PolygonTriangulation {
 public:
  using Index = std::uint32_t;
  using Triangle = std::array<Index, 3>;

  /// Loops of indices of `points`: the first is the outer one, counter-clockwise; the others, clockwise, are holes. Loops
  /// shorter than three are allowed (they vanish, or become slits).
  PolygonTriangulation(std::span<const Point> points, std::span<const std::vector<Index>> loops);

  const std::vector<Triangle>& triangles() const { return triangles_; }
  bool is_proper() const { return proper_; }

 private:
  struct Node {
    Index point, previous, next;
    bool alive;
  };
  enum class Care { strict, touching, turning, any };

  Index add_loop(const std::vector<Index>& loop);
  void join_hole(Index hole, Index outer);
  Index bridge_end(Index hole, Index outer) const;
  void clip(Index start);
  bool is_ear(Index node, Care care) const;
  bool is_blocked(Index node, Care care) const;
  bool blocks(Index other, Index ear, Care care) const;
  int turn(Index node) const;
  Point place(Index node) const { return points_[nodes_[node].point]; }

  void build_grid(Index start, std::size_t count);
  std::size_t grid_cell(double value, double low, double size) const;

  std::span<const Point> points_;
  std::vector<Node> nodes_;
  std::vector<Triangle> triangles_;
  bool proper_ = true;

  // Large polygons: nodes by the cells of a grid.
  std::size_t grid_side_ = 0;
  double grid_x_ = 0, grid_y_ = 0, grid_width_ = 1, grid_height_ = 1;
  std::vector<Index> grid_begin_, grid_node_;
};

}  // namespace krepl::output
