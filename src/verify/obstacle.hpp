#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "krepl/point.hpp"
#include "verify/bands.hpp"
#include "verify/circular_arc.hpp"
#include "verify/nearest_tree.hpp"

namespace krepl::verify {

/// One part of the input as it was read: an open line (one vertex: a point) or a ring of a polygon.
struct InputPart {
  std::vector<Point> vertices;
  bool ring = false;
  std::int64_t feature = -1;  ///< rings of one feature count by the even-odd rule
  double radius = 0;          ///< of its own; 0: the one of the zone
  std::vector<std::uint32_t> middles = {};  ///< ascending: vertices that are the middle of an arc between their neighbours
};

/// The input of a zone: segments and points as they were read, nothing welded, cut or dropped.
///
/// Parts may have radii of their own. Then the zone's radius R is the largest of them, and all distances to a part count
/// as larger by its *inset*, R less its own radius: so the boundary is at distance R of the input, whatever the radii.
class Obstacle {
 public:
  struct Segment {
    Point a, b;  ///< equal: a point
    Real inset = 0;
    std::shared_ptr<const CircularArc> arc = {};  ///< an arc from a to b; null: straight
    Box box() const {
      if (arc) return arc->box();
      Box r;
      r.add(a), r.add(b);
      return r;
    }
    Real distance(Vec p) const { return (arc ? arc->distance(p) : distance_to_segment(p, a, b)) + inset; }
  };
  struct Vertex {
    Point at;
    Real inset = 0;
    Box box() const {
      Box r;
      r.add(at);
      return r;
    }
    Real distance(Vec p) const { return verify::distance(p, at) + inset; }
  };

  /// `radius`: of the zone, where parts have radii of their own.
  explicit Obstacle(const std::vector<InputPart>& parts, double radius = 0);

  const NearestTree<Segment>& segments() const { return segments_; }
  const NearestTree<Vertex>& vertices() const { return vertices_; }
  Box box() const { return segments_.box(); }
  /// Half the larger side of the box: the extent after the input's own origin is taken off.
  Real extent() const;
  /// Distance between neighbouring doubles at the largest absolute coordinate.
  Real resolution() const;

  /// Distance to the lines, points and rings (more their insets); the inside of polygons does not count.
  Real distance(Vec p) const { return segments_.nearest(p).distance; }
  /// True if p is inside some polygon by the even-odd rule of its feature.
  bool in_polygon(Vec p) const;
  bool has_polygons() const { return !sides_.empty(); }
  bool has_arcs() const { return !arcs_.empty(); }
  /// Length inside the zone of radius r of the line at height y of the ray frame, from the cigars themselves: each
  /// meets the line in one interval, and the union of the intervals is measured.
  Real section(Real y, Real r) const;
  /// Lowest and highest point of the input in the ray frame.
  std::pair<Real, Real> heights() const;
  /// Appends the heights, in the ray frame, at which cigars of radius r begin and end, and their caps too.
  void add_ends(Real r, std::vector<Real>& out) const;

 private:
  struct Side {  // of a polygon ring, in the ray frame
    Vec a, b;
    std::uint32_t polygon;
    std::shared_ptr<const CircularArc> arc;
    bool crosses(Vec p) const;  // the ray towards +x an odd number of times
  };
  struct Arc {  // of the input, in the ray frame
    CircularArc curve;
    Real inset, low, high;
  };
  using Interval = std::pair<Real, Real>;
  void add_cigars(Real y, Real r, std::vector<Interval>& out) const;
  void add_arcs(Real y, Real r, std::vector<Interval>& out) const;
  void add_polygons(Real y, std::vector<Interval>& out) const;

  static std::vector<Segment> cut(const std::vector<InputPart>& parts, double radius);
  static std::vector<Vertex> corners(const std::vector<InputPart>& parts, double radius);

  NearestTree<Segment> segments_;
  NearestTree<Vertex> vertices_;
  struct Axis {
    Vec low, high;
    Real inset;
  };
  std::vector<Axis> axes_;  // the segments in the ray frame, by lower end
  Real tallest_ = 0;
  std::vector<Arc> arcs_;
  std::vector<Side> sides_;
  Bands side_bands_;
};

}  // namespace krepl::verify
