#pragma once

#include <cstddef>

#include "krepl/point.hpp"

namespace krepl::mill {

/// A directed line of the plane: its places are origin + t direction, the direction of length 1.
struct Line {
  Point origin, direction;
  Point at(double t) const { return {origin.x + t * direction.x, origin.y + t * direction.y}; }
};

/// The height of a body over a place of a line, and how it changes along the line.
struct Touch {
  double height, slope;
};

struct Interval {
  double low, high;
};

/// What a cutter's control point must stay above along a line: the highest of bodies, each of which has a height that
/// is a concave function over one interval of the line. Sums of a convex cutter and a triangle are such bodies. Between
/// places where it is known, a concave function lies above its chords and below its tangents; that is all that drive
/// curves need.
///
/// This is where other cutters than balls come in. Not for use by several threads.
class LineBodies {
 public:
  virtual ~LineBodies() = default;

  /// Lists the bodies that may be highest somewhere between t = from and t = to and higher than `floor`. False if they
  /// are too many: a shorter stretch should be asked for. With `all` it never fails.
  virtual bool list(const Line& line, double from, double to, double floor, bool all) = 0;
  /// Whether the cutter touched anything over the middle of the stretch listed last.
  virtual bool touches() const = 0;
  virtual std::size_t size() const = 0;
  /// Where the body lies above or below the line at all, within the stretch and beyond.
  virtual Interval domain(std::size_t body) const = 0;
  /// Precondition: t is inside the domain.
  virtual Touch at(std::size_t body, double t) const = 0;
  /// At least the body's greatest height where the domain is not longer than `width`.
  virtual double top_of_narrow(std::size_t body, double width) const = 0;
  /// A length of stretch over which lists are expected to be short.
  virtual double stretch() const = 0;
};

}  // namespace krepl::mill
