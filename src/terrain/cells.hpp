#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "krepl/context.hpp"
#include "terrain/cell_map.hpp"
#include "terrain/envelope.hpp"

namespace krepl::terrain {

/// One side's part of a cell: crossings [first, last) of a line; label at its start.
struct CellSide {
  Index line, first, last, label;
};

/// Cuts a tile into cells until each tells what is inside, and writes that into a CellMap. What double cannot tell in
/// small cells is passed on to the same in twice the digits.
template <class Real>
class Cells {
 public:
  using Point = PointOf<Real>;
  using Box = BoxOf<Real>;
  using Bound = BoundOf<Real>;
  using Patch = PatchOf<Real>;
  using Gradient = GradientOf<Real>;
  using Range = RangeOf<Real>;
  using GradientRange = GradientRangeOf<Real>;
  struct Cell {
    Box box;
    CellSide side[4];         ///< bottom, right, top, left, each in the direction of ascending coordinates
    bool just_asked = false;  ///< next to nothing was hidden in the cell around: not to be asked again at once
  };

  /// `finer`: null for the last one.
  Cells(CellMap& map, Envelope<Real>& envelope, SurfaceCounters& counters, const Context& context,
        Cells<DoubleDouble>* finer = nullptr);

  /// Settles a cell. False if cancelled or if a place cannot be settled: the map's failed_at.
  bool run(const Cell& cell, std::span<const Index> candidates);

 private:
  /// Where the boundary of a cell changes its label, counter-clockwise.
  struct Turn {
    Index crossing;
    int side;  // of the crossing's line, on which the cell lies
    Index before, after;
    Meeting meeting;
    Point at;
  };

  /// A curve from a turn to its mate, or to the vertex.
  struct Strand {
    std::size_t turn;
    Point end;
  };

  struct Cut {
    bool vertical;
    double at;
  };

  /// What vanishes along the curve of one turn: a side of a patch's domain, or a difference of heights.
  struct Condition {
    const Bound* bound;  // null: heights of a and b
    Index a, b;
    bool at_rim;  // b's height where it ends in a wall
  };

  /// A function over a box: in its middle, up to second derivatives, and how large third ones may be along any direction.
  struct Expansion {
    Real value;
    Gradient gradient;
    typename Envelope<Real>::Curvature curvature;
    Expansion operator-(const Expansion& e) const {
      return {value - e.value, {gradient.x - e.gradient.x, gradient.y - e.gradient.y}, curvature + e.curvature * Real(-1)};
    }
    Expansion operator*(Real k) const { return {k * value, {k * gradient.x, k * gradient.y}, curvature * k}; }
    Real most(const Box& box) const;
  };

  static constexpr std::size_t most_settled = 24;  // candidates; cells with more are cut at once

  bool subdivide(const Cell& cell, std::size_t first, int depth);
  Cut cut(const Cell& cell, std::span<const Index> candidates);
  Gradient steepness(const Box& box) const;
  std::optional<Cut> cut_between_strips(const Cell& cell);
  std::optional<Cut> cut_beside_wall(const Box& box) const;
  std::optional<Cut> cut_between_vertices(const Box& box) const;
  void add_likely_vertices(const Box& box);
  bool split(const Cell& cell, std::size_t first, int depth, bool just_asked);
  void add_seen(std::size_t first);
  bool is_hard(const Box& box) const;
  bool refine(const Cell& cell, std::span<const Index> candidates);
  void walk(const Cell& cell);
  bool settle(const Cell& cell, std::span<Index> candidates, bool smallest);
  std::optional<Point> crossing_of_edges(const Turn& turn, const Box& box) const;
  bool settle_arc(const Box& box, bool smallest);
  bool settle_crossing(const Box& box);
  bool settle_strips(const Box& box);
  bool pair_turns();
  std::optional<Point> vertex_of_star(const Box& box);
  bool are_apart(const Strand& a, const Strand& b, std::optional<Point> vertex, const Box& box) const;
  bool is_beside(const Strand& strand, Point vertex) const;
  bool labels_differ() const;
  bool is_pinched(const Box& box) const;
  bool settle_star(const Box& box, bool smallest);
  std::optional<Point> star_point(const Box& box) const;
  std::optional<Point> common_point(const Box& box) const;
  Real value(const Condition& condition, Point p) const;
  Gradient gradient(const Condition& condition, Point p) const;
  GradientRange gradient_range(const Condition& condition, const Box& box) const;
  std::pair<std::size_t, std::size_t> crossing_most(std::span<const Condition> conditions, Point p) const;
  bool cross_once(const Condition& c, const Condition& d, const Box& box) const;
  bool is_met_once(std::span<const Condition> conditions, std::size_t first, std::size_t second, const Box& box) const;
  bool hides_label(Point p) const;
  bool is_steep() const;
  Point least_gap(const Box& box) const;
  std::optional<Point> corner_beside(Point p) const;
  std::optional<Point> level_along(const Bound& wall, Index first, Index second, Point near) const;
  std::optional<Point> change_of_upper_wall(const Turn& s, const Turn& t, const Box& box) const;
  std::optional<Point> level_of_walls(Point p) const;
  std::optional<Point> touch_of_balls(Index a, Index b) const;
  std::optional<Point> touch_of_balls_beside(Point p) const;
  Real reach_of_touch() const;
  Point known_beside(Point p) const;
  std::optional<Point> common_corner(const Box& box) const;
  std::optional<Point> touch_of_walls(const Box& box) const;
  bool all_reach(Point p) const;
  bool reaches(Index patch, Point p) const;
  bool is_within(Index patch, Point p, Real beyond) const;
  bool shows_at(Index patch, Point p) const;
  bool is_wall_of(const Turn& turn, Index label) const;
  std::pair<Index, Index> sides_of_wall(const Turn& turn) const;
  const Bound* side_along(const Turn& turn) const;
  bool has_corner(Index patch, Point p) const;
  bool is_covered(Point p) const;
  bool hides_foot_of_seam(Point corner) const;
  bool share_corner(Index a, Index b, Point p) const;
  bool curve_is_simple(const Turn& turn, const Box& box) const;
  Range slope_of_difference(Index a, Index b, const Box& box, Gradient direction) const;
  bool stays_wall(const Turn& from, Point to, const Box& box) const;
  bool stays_valley(const Turn& from, Point to, const Box& box) const;
  bool cannot_close(Index a, Index b, const Box& box) const;
  Index first_in_plane(const Turn& turn, const Box& box) const;
  std::optional<Point> corner_of_first(const Turn& turn, const Box& box) const;
  const Bound* nearest_side(Index patch, Point p) const;
  bool sides_of_one_patch(const Turn& s, const Turn& t, const Box& box, Index& patch) const;
  bool shows_all(const Cell& cell, std::span<Index> candidates);
  bool is_seen(Index label) const;
  bool is_thin(Index patch, Index a, Index b, const Box& box, Real width, bool crossed = false) const;
  std::optional<Point> end_of_thin_bend(const Box& box) const;
  std::optional<Point> end_of_thin_strip() const;
  bool is_thin_bend(Index a, Index b, const Box& box) const;
  bool is_tangent_sliver(Index patch, const Box& box) const;
  bool is_met_along_wall(Index patch, const Bound& wall, Index behind, const Box& box) const;
  bool is_met_beside_wall(Index patch, Index upper, const Box& box) const;
  bool are_apart_by_expansion(const Turn& s, const Turn& t, const Box& box) const;
  Expansion height_expansion(Index patch, const Box& box) const;
  Expansion side_expansion(const Bound& side, const Box& box) const;
  std::optional<Expansion> upright_expansion(Index round, Index other, const Box& box) const;
  bool is_hidden_beside_wall(Index patch, const Box& box) const;
  bool all_are_prisms(std::span<const Index> candidates, const Box& box) const;
  bool is_hidden(Index patch, const Box& box) const;
  bool corner_in(Index patch, const Box& box) const;
  bool may_end(const Turn& side, std::optional<Point> vertex, const Box& box) const;
  template <class Condition>
  bool has_corner_where(Index patch, const Box& box, const Condition& holds) const {
    if (patch == none) return false;
    const Real slack = envelope_.smallest_cell();
    const Box wide{{box.low.x - slack, box.low.y - slack}, {box.high.x + slack, box.high.y + slack}};
    const auto corners = envelope_.patches().corners(patch);
    return std::any_of(corners.begin(), corners.end(), [&](Point c) { return wide.contains(c) && holds(c); });
  }
  bool is_upright(Index patch, Point p) const;
  Real bend(const Turn& turn, Point end, const Box& box) const;
  bool wall_keeps_off(const Turn& from, Point to, const Turn& valley) const;
  void connect(const Turn& a, const Turn& b);
  Real label_height(Index label, Point at) const;
  Real vertex_height(Point at) const;
  Real height_beside_steep_face(Point at) const;
  void add_vertex(Point at);

  CellMap& map_;
  Envelope<Real>& envelope_;
  SurfaceCounters& counters_;
  const Context& context_;
  Cells<DoubleDouble>* finer_;
  std::vector<Index> stack_;                         // candidates
  std::vector<Index> kept_;                          // of a cell, before they are added there
  std::array<std::vector<double>, 2> corner_place_;  // x and y of corners in a cell
  std::vector<Turn> turns_;
  std::vector<int> mate_;          // per turn: the other end of its curve; -1: that ends in the vertex
  std::vector<Turn> star_;         // turns without a mate
  std::vector<Index> seen_;        // labels around the cell
  std::vector<Index> turn_piece_;  // per turn: a piece of the run before it
  std::vector<LineCrossing> found_;
  std::vector<Link> arms_;
};

extern template class Cells<double>;
extern template class Cells<DoubleDouble>;

}  // namespace krepl::terrain
