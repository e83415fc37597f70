#pragma once

#include <optional>
#include <vector>

#include "krepl/context.hpp"
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
class Cells {
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

  Cells(const PatchSet& patches, double scale, SurfaceCounters& counters, const Context& context);

  Envelope& envelope() { return envelope_; }

  /// Adds a line with its crossings; the tile's own sides come first: bottom, right, top, left.
  Index add_line(bool vertical, double at, Index start_label, const std::vector<Envelope::Crossing>& crossings);

  /// Subdivides the tile, whose sides are lines 0 to 3. False if cancelled or if a place cannot be settled: failed_at().
  bool run(const Box& tile, std::span<const Index> candidates);
  std::optional<Point> failed_at() const { return failed_at_; }

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

 private:
  struct Side {
    Index line, first, last, label;  // crossings [first, last) of the line; label at the side's start
  };
  struct Cell {
    Box box;
    Side side[4];  // bottom, right, top, left, each in the direction of ascending coordinates
  };
  /// Where the boundary of a cell changes its label, counter-clockwise.
  struct Turn {
    Index crossing;
    int side;       // of the crossing's line, on which the cell lies
    Index before, after;
    Meeting meeting;
    Point at;
  };

  struct Cut {
    bool vertical;
    double at;
  };

  static constexpr std::size_t most_settled = 24;  // candidates; cells with more are cut at once

  bool subdivide(const Cell& cell, std::size_t first, int depth);
  Cut cut(const Cell& cell, std::span<const Index> candidates);
  Gradient steepness(const Box& box) const;
  std::optional<Cut> cut_between_strips(const Cell& cell);
  std::optional<Cut> cut_beside_wall(const Box& box) const;
  void add_likely_vertices(const Box& box);
  bool split(const Cell& cell, std::size_t first, int depth);
  void walk(const Cell& cell);
  bool settle(const Cell& cell, std::span<const Index> candidates, bool smallest);
  bool settle_arc(const Box& box, bool smallest);
  bool settle_strips(const Box& box);
  bool settle_star(const Box& box, bool smallest);
  std::optional<Point> star_point(const Box& box) const;
  Point least_gap(const Box& box) const;
  std::optional<Point> corner_beside(Point p, const Box& box) const;
  std::optional<Point> common_corner(const Box& box) const;
  bool all_reach(Point p) const;
  bool reaches(Index patch, Point p) const;
  bool shows_at(Index patch, Point p) const;
  bool is_wall_of(const Turn& turn, Index label) const;
  std::pair<Index, Index> sides_of_wall(const Turn& turn) const;
  const Bound* side_along(const Turn& turn) const;
  bool has_corner(Index patch, Point p) const;
  bool share_corner(Index a, Index b, Point p) const;
  bool curve_is_simple(const Turn& turn, const Box& box) const;
  bool stays_wall(const Turn& from, const Turn& to, const Box& box) const;
  bool cannot_close(Index a, Index b, const Box& box) const;
  bool are_coplanar(Index a, Index b, const Box& box) const;
  bool sides_of_one_patch(const Turn& s, const Turn& t, const Box& box, Index& patch) const;
  bool shows_all(const Cell& cell, std::span<const Index> candidates);
  bool is_seen(Index label) const;
  bool is_thin(Index patch, Index a, Index b, const Box& box, double width) const;
  std::optional<Point> end_of_thin_bend(const Box& box) const;
  bool is_thin_bend(Index a, Index b, const Box& box) const;
  bool is_tangent_sliver(Index patch, const Box& box) const;
  bool all_are_prisms(std::span<const Index> candidates, const Box& box) const;
  bool is_hidden(Index patch, const Box& box) const;
  bool corner_in(Index patch, const Box& box) const;
  double bend(const Turn& turn, Point end, const Box& box) const;
  bool wall_stays_above(const Turn& from, const Turn& to, const Turn& valley) const;
  void connect(const Turn& a, const Turn& b);
  void add_vertex(Point at);
  void unite(Index a, Index b);

  Envelope envelope_;
  SurfaceCounters& counters_;
  const Context& context_;
  bool far_;  // R is at least the extent
  std::vector<CellLine> lines_;
  std::vector<Crossing> crossings_;
  std::vector<Vertex> vertices_;
  std::vector<Link> arms_;
  std::vector<Index> region_;  // union-find over pieces
  std::vector<Index> stack_;   // candidates
  std::array<std::vector<double>, 2> corner_place_;  // x and y of corners in a cell
  std::vector<Turn> turns_;
  std::vector<Index> seen_;        // labels around the cell
  std::vector<Index> turn_piece_;  // per turn: a piece of the run before it
  std::vector<Envelope::Crossing> found_;
  std::optional<Point> failed_at_;
};

}  // namespace krepl::terrain
