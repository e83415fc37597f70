#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "kernel/quad.hpp"
#include "krepl/context.hpp"
#include "krepl/network.hpp"
#include "zone/varied_sites.hpp"

namespace krepl::zone {

using kernel::quad;

template <class Real>
struct Vector {
  Real x, y;
};
template <class Real>
Real dot(Vector<Real> a, Vector<Real> b) {
  return a.x * b.x + a.y * b.y;
}
template <class Real>
Real cross(Vector<Real> a, Vector<Real> b) {
  return a.x * b.y - a.y * b.x;
}
template <class Real>
Vector<Real> operator+(Vector<Real> a, Vector<Real> b) {
  return {a.x + b.x, a.y + b.y};
}
template <class Real>
Vector<Real> operator-(Vector<Real> a, Vector<Real> b) {
  return {a.x - b.x, a.y - b.y};
}
template <class Real>
Vector<Real> operator*(Real s, Vector<Real> a) {
  return {s * a.x, s * a.y};
}
template <class Real>
Real length(Vector<Real> v) {
  return kernel::square_root(v.x * v.x + v.y * v.y);
}

/// The concrete, non-degenerate instance whose topology is computed (docs/zone.md, "One instance").
///
/// Vertices are the network's, moved by at most jitter(), 2^-72 of the extent or 2^-88 R, in a direction that is a hash
/// of their coordinates; the radius is enlarged by 2^-48 S or 4 units in the last place of the coordinates, whichever
/// is more. Double precision sees the unmoved vertices and counts the move as an error; quadruple precision sees the
/// moved ones. So every decision is about the same instance, and decisions taken at different elements cannot
/// contradict each other.
///
/// Where radii differ (VariedSites), a vertex stands once for each radius of the segments that meet there: copies share
/// coordinates, and so their move, and nothing else. Segments of one radius are neighbours as ever; to those of another
/// radius they are strangers that cross.
///
/// Boundary elements have numbers: 2s is the offset line on the right of segment s as it runs from a to b, 2s+1 the one
/// on the right of its reverse; side_count() + v is the circle about vertex v. Sites are the segments, then the
/// isolated vertices as segments of length zero.
class Instance {
 public:
  struct Ends {
    Index from, to;
  };

  /// `resolution`: pieces shorter than this will be contracted, so vertices may be displaced by a quarter of it.
  Instance(const Network& network, double nominal_radius, double radius, double resolution, const Context& context);
  /// With a radius for each vertex; `sites` must outlive the instance.
  Instance(const Network& network, const VariedSites& sites, double enlargement, double resolution,
           const Context& context);
  /// The same moved vertices at another radius. O(1).
  Instance(const Instance& other, double nominal_radius, double radius, double resolution);

  /// The enlarged radius, which decides everything; where radii differ, the largest.
  double radius() const { return radius_; }
  /// The radius as given, for coordinates where the difference cannot matter; where radii differ, the largest.
  double nominal_radius() const { return nominal_radius_; }
  /// The smallest enlarged radius.
  double least_radius() const { return least_radius_; }
  /// The enlarged radius, and the one as given, of an element and of a site.
  double radius_of(Index element) const { return radii_.empty() ? radius_ : radii_[owner(element)] + enlargement(); }
  double nominal_radius_of(Index element) const { return radii_.empty() ? nominal_radius_ : radii_[owner(element)]; }
  double site_radius(Index i) const { return radii_.empty() ? radius_ : radii_[site(i).a] + enlargement(); }
  /// Crossings at least this well conditioned may be evaluated with the nominal radius.
  double nominal_condition() const { return nominal_condition_; }
  double enlargement() const { return enlargement_; }
  double jitter() const { return jitter_; }
  /// Largest absolute coordinate of a vertex.
  double extent() const { return extent_; }
  std::span<const Point> vertices() const { return vertices_; }

  Index side_count() const { return Index(2 * segments_.size()); }
  Index element_count() const { return side_count() + Index(vertices_.size()); }
  Index site_count() const { return Index(segments_.size() + shape_->isolated.size()); }
  Network::Segment site(Index i) const {
    return i < segments_.size()
               ? segments_[i]
               : Network::Segment{shape_->isolated[i - segments_.size()], shape_->isolated[i - segments_.size()]};
  }

  bool is_side(Index element) const { return element < side_count(); }
  Index circle(Index vertex) const { return side_count() + vertex; }
  Index vertex_of(Index circle_element) const { return circle_element - side_count(); }
  /// Ends of the directed segment on whose right the side lies.
  Ends ends(Index side) const {
    const auto s = segments_[side >> 1];
    return (side & 1u) ? Ends{s.b, s.a} : Ends{s.a, s.b};
  }

  /// The visible sector of a vertex: the side whose end starts its arc and the side that starts where the arc ends; none
  /// where the segments around the vertex leave no gap above 180 degrees. Both are the circle itself at an isolated vertex.
  struct Sector {
    Index before, after;
  };
  Sector sector(Index vertex) const { return shape_->sectors[vertex]; }

  /// True if the direction from `at` to `to` is counter-clockwise of that to `from`, by less than 180 degrees.
  bool turns_left(Index at, Index from, Index to) const;

  /// to - from, in double precision of the unmoved vertices, in quadruple precision of the moved ones.
  template <class Real>
  Vector<Real> difference(Index to, Index from) const {
    if constexpr (std::is_same_v<Real, double>) {
      return {vertices_[to].x - vertices_[from].x, vertices_[to].y - vertices_[from].y};
    } else {
      const auto p = moved(to), q = moved(from);
      return {p.x - q.x, p.y - q.y};
    }
  }
  Vector<quad> moved(Index vertex) const;
  /// By how much it is moved; moved() rounds to quadruple precision.
  Vector<double> move(Index vertex) const;

  /// Bound of the error that the move causes in a coordinate, as seen by Real.
  template <class Real>
  double unseen_move() const {
    return std::is_same_v<Real, double> ? jitter_ : 0.0;
  }

 private:
  /// What does not depend on the radius.
  struct Shape {
    std::vector<Index> isolated;
    std::vector<Sector> sectors;
  };
  void find_shape(const Context& context);
  /// A vertex that has the element's radius.
  Index owner(Index element) const { return is_side(element) ? segments_[element >> 1].a : vertex_of(element); }
  Sector find_sector(Index vertex, std::span<const Index> outgoing) const;

  std::span<const Point> vertices_;
  std::span<const Network::Segment> segments_;
  std::span<const double> radii_;  // as given, per vertex; none where all are equal
  double nominal_radius_;
  double radius_;
  double least_radius_;
  double enlargement_;
  double nominal_condition_;
  double extent_;
  double jitter_;
  std::shared_ptr<const Shape> shape_;
};

}  // namespace krepl::zone
