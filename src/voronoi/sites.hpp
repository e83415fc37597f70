#pragma once

#include <algorithm>
#include <span>
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

/// The elements that a site brings along, as bits: the sides of a segment (2s, 2s+1) and the vertices it owns.
using SiteParts = unsigned;
inline constexpr SiteParts first_side = 1, second_side = 2, start_vertex = 4, end_vertex = 8, both_sides = 3, all_parts = 15;

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
  /// Places of this clearance that are no farther apart are one: a link between them is none, and more than three faces
  /// meet there. Ties (circles that touch four sites) are ordinary, and double precision cannot resolve them; 2^-50 is
  /// below what decides at which radii a place is covered (the radius is enlarged by 2^-48 S).
  double coincidence(double clearance) const { return 0x1p-50 * std::max(in_.extent(), clearance); }
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
  /// What a side's border begins with (end 0, where its segment starts) or ends with (1): the vertex's face, or the side
  /// across the gap between the two segments.
  Index corner(Index side, int end) const { return corner_[2 * side + Index(end)]; }
  /// The site that brings a vertex's face along, so that no face is looked at twice; none if the vertex has no face.
  Index owner(Index vertex) const { return owner_[vertex]; }
  /// The site that brings an element along, and which part of it the element is.
  Index site_of(Index element) const { return is_side(element) ? element >> 1 : owner_[in_.vertex_of(element)]; }
  SiteParts part_of(Index element) const {
    if (is_side(element)) return (element & 1u) ? second_side : first_side;
    const Index v = in_.vertex_of(element);
    return in_.site(owner_[v]).a == v ? start_vertex : end_vertex;
  }

 private:
  template <class Real>
  Vector<Real> unit(Index segment) const {
    const auto s = in_.site(segment);
    const Vector<Real> d = difference<Real>(s.b, s.a);
    const Real l = length(d);
    return {d.x / l, d.y / l};
  }

  void find_corners(const Context& context);
  void find_corners_of(Index vertex, std::span<Index> outgoing);

  const Instance& in_;
  double horizon_;
  std::vector<Index> corner_;
  std::vector<Vector<double>> direction_;
  std::vector<Index> owner_;
  std::vector<Vector<Twofold>> moved_;  // vertices
};

}  // namespace krepl::voronoi
