#pragma once

#include <type_traits>
#include <vector>

#include "kernel/wide.hpp"
#include "krepl/context.hpp"
#include "voronoi/twofold.hpp"
#include "zone/instance.hpp"

namespace krepl::voronoi {

using kernel::quad;
using kernel::wide;
using kernel::widened;
using zone::Index;
using zone::Instance;
using zone::none;
template <class Real>
using Vector = zone::Vector<Real>;  // its arithmetic is found there

/// Faces end this far from their site, in extents of the network.
inline constexpr double horizon_in_extents = 0x1p20;

/// The instance of docs/zone.md with what cells ask of it again and again. Elements are numbered as there: side 2s lies
/// on the right of segment s from a to b, 2s+1 on the right of its reverse, side_count() + v is vertex v.
class Sites {
 public:
  Sites(const Instance& instance, const Context& context);

  const Instance& instance() const { return in_; }
  /// Faces end at this distance from their site. Beyond it, bends of a line of collinear vertices that only the move of
  /// vertices makes would show.
  double horizon() const { return horizon_; }
  bool is_side(Index element) const { return in_.is_side(element); }

  /// to - from: of the unmoved vertices in double precision, of the moved ones otherwise.
  template <class Real>
  Vector<Real> difference(Index to, Index from) const {
    if constexpr (std::is_same_v<Real, Twofold>) {
      return moved_[to] - moved_[from];
    } else if constexpr (std::is_same_v<Real, wide>) {
      const auto p = in_.moved(to), q = in_.moved(from);
      return {widened(p.x) - widened(q.x), widened(p.y) - widened(q.y)};
    } else {
      return in_.difference<Real>(to, from);
    }
  }
  /// Unit vector from a to b of a segment.
  template <class Real>
  Vector<Real> direction(Index segment) const {
    if constexpr (std::is_same_v<Real, double>) {
      return direction_[segment];
    } else {
      return unit<Real>(segment);
    }
  }
  /// Unit vector away from the segment, on the side.
  template <class Real>
  Vector<Real> normal(Index side) const {
    const Vector<Real> d = direction<Real>(side >> 1);
    return (side & 1u) ? Vector<Real>{-d.y, d.x} : Vector<Real>{d.y, -d.x};
  }
  /// The site that brings a vertex's face along, so that no face is looked at twice; none if the vertex has no face.
  Index owner(Index vertex) const { return owner_[vertex]; }

 private:
  template <class Real>
  Vector<Real> unit(Index segment) const {
    const auto s = in_.site(segment);
    const Vector<Real> d = difference<Real>(s.b, s.a);
    const Real l = length(d);
    return {d.x / l, d.y / l};
  }

  const Instance& in_;
  double horizon_;
  std::vector<Vector<double>> direction_;
  std::vector<Index> owner_;
  std::vector<Vector<Twofold>> moved_;  // vertices
};

}  // namespace krepl::voronoi
