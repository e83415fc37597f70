#pragma once

#include "krepl/sweep.hpp"
#include "sweep/geometry.hpp"

namespace krepl::sweep {

/// A stretch of an element that is monotone in x: a part of a side, or of the upper or the lower half of a circle.
struct Curve {
  Index element;
  Index left, right;  ///< vertices, numbered as in its outline
  bool upper;         ///< the half, of circles
  bool rightward;     ///< it runs so with its inside on the left, that is, above
  int multiplicity;   ///< how many more outlines cover its inside than its outside

  /// By how much more the place above it is covered than the place below it.
  int rise() const { return rightward ? multiplicity : -multiplicity; }
};

/// Curves that together bound a region, or bound regions laid over each other.
struct Outline {
  std::vector<Vertex> vertices;
  std::vector<Curve> curves;
};

/// Decisions about the instance: double precision with error bounds, then quadruple precision, then 320 bits; what is
/// still open is ordered by its name, and counted. One object a thread.
class Predicates {
 public:
  explicit Predicates(const Geometry& geometry) : geometry_(geometry) {}

  /// The vertex of that name. Precondition: it exists.
  Vertex vertex(Index from, Index to);
  /// The one where a side touches the circle about its end; the half is left to the caller.
  Vertex touching(Index from, Index to) { return placed(from, to); }
  /// A place on one circle: Vertex::leftmost, rightmost or start.
  Vertex on_circle(Index circle, Index which);
  /// From left to right, at equal x from below: -1, 0 (the same vertex only) or 1.
  int compare(const Vertex& p, const Vertex& q);
  /// Where a vertex is as seen from a curve whose range of x it is in: -1 below, 0 on it, 1 above.
  int locate(const Vertex& p, const Curve& curve);
  /// True if the side runs from left to right.
  bool runs_rightward(Index side);
  /// True if the boundary leaves the first element for the second one somewhere.
  bool crosses(Index from, Index to);

  const Geometry& geometry() const { return geometry_; }
  SweepCounters counters;

 private:
  template <class Value>
  int decide(Value&& value);
  Vertex placed(Index from, Index to);
  template <class Real>
  Place<Real> place_of(const Vertex& v) const;
  bool is_on_upper_half(const Vertex& v, Index circle);
  template <class Real>
  Estimate<Real> above_side(const Vertex& p, const Curve& side) const;
  template <class Real>
  Estimate<Real> above_half(const Vertex& p, const Curve& arc) const;

  const Geometry& geometry_;
};

}  // namespace krepl::sweep
