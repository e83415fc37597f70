#pragma once

#include <optional>
#include <vector>

#include "krepl/point.hpp"

namespace krepl::input {

/// A circular arc through three places, of up to a full turn.
class ArcChords {
 public:
  /// Nothing if two of the places coincide (but start and end: the full circle that has `middle` opposite) or all three
  /// lie on a line. The same arc run the other way gives the same numbers.
  static std::optional<ArcChords> through(Point start, Point middle, Point end);

  /// Equal chords that are needed for a deviation of `max_error`; up to 2^40.
  double count(double max_error) const;
  /// How far `count` equal chords deviate.
  double deviation(double count) const;
  /// Appends the ends of `count` equal chords between start and end, without start and end themselves.
  void append_inner_ends(std::size_t count, std::vector<Point>& out) const;

 private:
  Point at(double fraction) const;

  Point first_, last_;  // in an order of their own: by x, then y
  bool reversed_;       // last_ is the start
  bool left_turn_;      // from first_ to last_
  double angle_;        // up to 2 pi
  Point center_;
  double radius_;
};

}  // namespace krepl::input
