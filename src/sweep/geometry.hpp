#pragma once

#include <type_traits>
#include <vector>

#include "kernel/wide.hpp"
#include "krepl/context.hpp"
#include "zone/instance.hpp"

namespace krepl::sweep {

using kernel::quad;
using kernel::wide;
using zone::Index;
using zone::Instance;
using zone::none;
template <class Real>
using Vector = zone::Vector<Real>;  // its arithmetic is found there

/// A number, and a bound of its error.
template <class Real>
struct Estimate {
  Real value, error;
  /// 0: the precision does not tell.
  int sign() const { return value > error ? 1 : value < -error ? -1 : 0; }
};

/// A place, and a bound of the error of each of its coordinates.
template <class Real>
struct Place {
  Vector<Real> at;
  Real error;
};

/// A place where the boundary leaves element `from` for element `to`: a crossing of the two, or, of a side and a circle
/// about its own end, where they touch. Two elements meet at most once in that order, so the pair names the place. An
/// extreme is the leftmost or rightmost point of a circle, where its lower and its upper half meet; its start is where
/// circles about isolated vertices begin.
struct Vertex {
  static constexpr Index leftmost = none - 1, rightmost = none - 2, start = none - 3;

  Index from = none, to = none;
  bool from_upper = false, to_upper = false;  ///< the halves it lies on, where `from` or `to` are circles
  double x = 0, y = 0, error = 0;             ///< as far as double precision tells

  bool is_extreme() const { return to == leftmost || to == rightmost; }
  bool is_on_one_circle() const { return is_extreme() || to == start; }
  bool is_same(const Vertex& o) const { return from == o.from && to == o.to; }
};

/// Coordinates of elements and vertices in the sweep's own frame: the plane turned, because lines of maps tend to run
/// along the axes, and scaled by 29/32, so that the turn is exact. Elements are those of zone::Instance; double
/// precision sees unmoved vertices of the network and counts their move as an error, the others see the moved ones.
class Geometry {
 public:
  Geometry(const Instance& instance, const Context& context);

  const Instance& instance() const { return in_; }
  bool is_side(Index element) const { return in_.is_side(element); }
  Index vertex_of(Index circle) const { return in_.vertex_of(circle); }

  template <class Real>
  Real radius() const {
    return Real(29) * Real(in_.radius()) / Real(32);
  }
  /// Of a vertex of the network.
  template <class Real>
  Vector<Real> position(Index vertex) const {
    if constexpr (std::is_same_v<Real, double>) {
      const Point p = in_.vertices()[vertex];
      return turned(Vector<double>{p.x, p.y});
    } else {
      const auto p = in_.moved(vertex);
      return turned(Vector<Real>{converted<Real>(p.x), converted<Real>(p.y)});
    }
  }
  template <class Real>
  Real position_error() const {
    return Real(16 * kernel::unit_roundoff<Real>) * Real(in_.extent()) + 4 * unseen<Real>();
  }
  template <class Real>
  Vector<Real> difference(Index to, Index from) const {
    if constexpr (std::is_same_v<Real, double>) {
      return turned(in_.difference<double>(to, from));
    } else {
      return position<Real>(to) - position<Real>(from);
    }
  }
  template <class Real>
  Real difference_error(const Vector<Real>& difference) const {
    const Real size = kernel::absolute(difference.x) + kernel::absolute(difference.y);
    Real error = Real(8 * kernel::unit_roundoff<Real>) * size + 4 * unseen<Real>();
    if constexpr (!std::is_same_v<Real, double>) error += 2 * position_error<Real>();
    return error;
  }

  /// A side: where its segment starts, the direction in which it runs, the way from the segment to the side.
  template <class Real>
  struct Line {
    Vector<Real> base, direction, normal;
    Real direction_error;
  };
  template <class Real>
  Line<Real> line(Index side) const;

  /// Where a vertex lies. Precondition: the crossing exists.
  template <class Real>
  Place<Real> place(const Vertex& v) const;
  /// False where incidence tells that two elements do not cross in that order: it needs no arithmetic and must not use
  /// it.
  bool may_cross(Index from, Index to) const;
  /// Positive if they do. Precondition: may_cross.
  template <class Real>
  Estimate<Real> crosses(Index from, Index to) const;

  /// Places known less exactly than this are evaluated once more.
  double coarse() const { return coarse_; }
  /// In double precision, from a table.
  double span(Index side) const { return span_[side >> 1]; }

 private:
  template <class Real>
  static Vector<Real> turned(Vector<Real> v) {
    return {(20 * v.x + 21 * v.y) / 32, (20 * v.y - 21 * v.x) / 32};
  }
  template <class Real>
  static Real converted(quad x) {
    if constexpr (std::is_same_v<Real, wide>) {
      return kernel::widened(x);
    } else {
      return x;
    }
  }
  template <class Real>
  Real unseen() const {
    return Real(in_.unseen_move<Real>());
  }
  template <class Real>
  void set_direction(Line<Real>& line, Vector<Real> d) const;
  template <class Real>
  Place<Real> touching(Index side, Index circle) const;
  template <class Real>
  Place<Real> side_and_side(Index from, Index to) const;
  template <class Real>
  Place<Real> side_and_circle(Index side, Index circle, int sense) const;
  template <class Real>
  Place<Real> circle_and_circle(Index from, Index to) const;
  bool is_end(Index side, Index vertex) const {
    const auto e = in_.ends(side);
    return e.from == vertex || e.to == vertex;
  }

  const Instance& in_;
  double coarse_;
  std::vector<Vector<double>> direction_;  // of segments from a to b
  std::vector<double> span_, direction_error_;
};

}  // namespace krepl::sweep
