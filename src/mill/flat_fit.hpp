#pragma once

#include <cstdint>
#include <vector>

#include "mill/pass_layout.hpp"

namespace krepl::mill {

/// A lattice point of a level plane.
struct FlatPoint {
  std::int64_t i, j;
  friend bool operator==(const FlatPoint&, const FlatPoint&) = default;
};

/// A line, or an arc of at most half a turn.
struct FlatMove {
  int turn = 0;  ///< of arcs: 1 counter-clockwise, -1 clockwise
  FlatPoint end, centre;
};

struct FlatFitOptions {
  PlaneLattice lattice;
  double within = 0;       ///< largest distance of moves from the polyline: at least 2 units
  double most_radius = 0;  ///< of arcs; 0: none
  double least_radius = 0;
};

/// Fits lines and arcs between lattice points to a polyline of a level plane.
///
/// Every place of a move is near one of the polyline, in order: lines and arcs are accepted only where the polyline
/// runs on along them, all of its vertices are within the distance, and its segments do not come nearer to the centre
/// of an arc. From each start the farther of line and arc is taken; ends are found by doubling and halving.
class FlatFit {
 public:
  FlatFit(const std::vector<Point>& polyline, const FlatFitOptions& options) : points_(polyline), o_(options) {}
  /// Appends the moves; returns the start.
  FlatPoint run(std::vector<FlatMove>& moves);

 private:
  FlatPoint round(Point p) const;
  Point place(FlatPoint p) const { return o_.lattice.place(p.i, p.j); }
  bool is_line(FlatPoint start, std::size_t first, std::size_t last) const;
  bool find_arc(FlatPoint start, std::size_t first, std::size_t last, FlatMove& arc) const;
  FlatPoint centre_near(Point centre, Point start, Point end) const;
  bool follows(const FlatMove& arc, FlatPoint start, std::size_t first, std::size_t last) const;

  const std::vector<Point>& points_;
  const FlatFitOptions& o_;
};

}  // namespace krepl::mill
