#pragma once

#include <optional>
#include <vector>

#include "terrain/envelope.hpp"

namespace krepl::terrain {

/// A stretch of a line on which the labels are known: a side of cells.
struct CellLine {
  bool vertical;
  double at;
  Index start_label;
  Index first_crossing, crossing_count;
};

/// Where a boundary curve goes on inside a cell, as seen from a crossing: another crossing (and which side of its line the cell
/// lies on), or a vertex.
struct Link {
  static constexpr Index vertex_flag = Index{1} << 31;
  Index word = none;
  static Link crossing(Index c, int side) { return {2 * c + Index(side)}; }
  static Link vertex(Index v) { return {v | vertex_flag}; }
  bool is_vertex() const { return (word & vertex_flag) != 0; }
  Index index() const { return is_vertex() ? word & ~vertex_flag : word >> 1; }
  int side() const { return int(word & 1u); }
};

/// The subdivision of one tile: lines, where labels change along them, and how these places are connected inside cells.
///
/// Side 0 of a line is the one with smaller coordinates (left of a vertical, below a horizontal line), side 1 the other.
class CellMap {
 public:
  struct Crossing {
    double t;
    Index after;
    Meeting meeting;
    Link link[2];
  };
  struct Vertex {
    Point3 at;
    Index first_arm, arm_count;  ///< counter-clockwise; in arms()
  };

  /// Adds a line with its crossings; the tile's own sides come first: bottom, right, top, left.
  Index add_line(bool vertical, double at, Index start_label, const std::vector<LineCrossing>& crossings);
  void link(Index crossing, int side, Link to) { crossings_[crossing].link[side] = to; }
  /// A vertex whose arms lead to these crossings, counter-clockwise; each is linked to it.
  void add_vertex(Point3 at, std::span<const Link> arms);
  /// The pieces lie in the same face.
  void unite(Index piece, Index other);

  const std::vector<CellLine>& lines() const { return lines_; }
  const std::vector<Crossing>& crossings() const { return crossings_; }
  const std::vector<Vertex>& vertices() const { return vertices_; }
  /// Per arm: the crossing it leads to, with the side of that crossing's line on which the vertex lies.
  const std::vector<Link>& arms() const { return arms_; }
  Point place(Index line, const Crossing& c) const {
    return lines_[line].vertical ? Point{lines_[line].at, c.t} : Point{c.t, lines_[line].at};
  }
  /// Stretches of lines between crossings lie in one face each; number of the k-th one of a line.
  Index piece(Index line, Index k) const { return lines_[line].first_crossing + line + k; }
  Index piece_count() const { return Index(crossings_.size() + lines_.size()); }
  /// One number for all pieces that lie in the same face as far as this tile tells.
  Index region(Index piece);

  std::optional<Point> failed_at;  ///< a place that could not be settled

 private:
  std::vector<CellLine> lines_;
  std::vector<Crossing> crossings_;
  std::vector<Vertex> vertices_;
  std::vector<Link> arms_;
  std::vector<Index> region_;  // union-find over pieces
};

}  // namespace krepl::terrain
