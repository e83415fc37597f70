#pragma once

#include <cstdint>
#include <vector>

#include "krepl/zone.hpp"

namespace krepl::output {

/// Turns rings into polygons for formats without curves.
///
/// Vertices lie on the true boundary, so chords lie inside the disks that the arcs belong to: the polygons are valid and
/// inside the true zone, by `max_error` at most. (A chord cannot meet another part of the boundary: the sliver between it
/// and its arc is inside one disk, and no boundary runs through the inside of a disk.)
class Linearizer {
 public:
  /// max_error > 0, in the unit of the coordinates. `radius`: of arcs that do not tell their own.
  Linearizer(double radius, double max_error);

  /// The ring's vertices; first and last are equal.
  std::vector<Point> ring(const Zone& zone, std::uint32_t ring);
  /// Appends the vertices of an arc after its start.
  void append_arc(const Zone::Piece& arc, std::vector<Point>& points);
  /// The largest distance between a chord and its arc so far.
  double deviation() const { return deviation_; }

  /// The finest max_error that makes sense for a radius: below it, chords are shorter than rounding allows.
  static double finest(double radius) { return 1e-12 * radius; }

 private:
  void append_arc_of_input(const Zone::Piece& arc, std::vector<Point>& points);
  double radius_, max_error_;
  double largest_step_;
  double deviation_ = 0;
};

}  // namespace krepl::output
