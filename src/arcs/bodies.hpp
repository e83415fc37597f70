#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "arcs/radii.hpp"
#include "kernel/box_tree.hpp"
#include "krepl/curve_network.hpp"
#include "krepl/shape.hpp"
#include "zone/instance.hpp"

namespace krepl::arcs {

using kernel::quad;
using Index = std::uint32_t;
inline constexpr Index none = ~Index{0};
template <class Real>
using Vector = zone::Vector<Real>;

/// What a border of a body is a copy of: borders of several bodies may lie on one line or circle.
struct Key {
  enum class Kind : std::uint8_t {
    side,     ///< index 2s: right of segment s as it runs from a to b, 2s+1: right of its reverse
    chord,    ///< the same of an arc too flat to show
    circle,   ///< about a vertex
    outer,    ///< about an arc's centre, radius r + R
    inner,    ///< about an arc's centre, radius r - R
    beyond,   ///< about an arc's centre, radius R - r: what is beside the arc beyond its centre
    end,      ///< across an end of segment s: 2s, at its b 2s+1
    flat_end, ///< the same of an arc too flat to show
    wall,     ///< across an end of an arc: 2a, at its last place 2a+1
    tangent,  ///< straight on from where an arc ends: 4a + 2 (at its last place) + 1 (right of what leaves it)
    bevel,    ///< from one side of a bend to the other
    square,   ///< of a square cap: 4b + k, b its bend
    inside    ///< index none: between bodies that belong together, covered but for what is too short to show
  };
  Kind kind;
  Index index;
  friend bool operator==(const Key&, const Key&) = default;
};

/// A straight border from p to q with the body on its left; or an arc about c, counter-clockwise from p to q with the
/// body inside the circle, or clockwise with the body outside. p == q: the full circle.
template <class Real>
struct Border {
  bool arc = false, clockwise = false;
  Key key;
  Vector<Real> p, q, c;
  Real radius = 0;
  bool fine = false;  // in double precision: too short for its ends to tell its direction
};

/// The places on the left of all its straight borders, within its counter-clockwise circles and outside its clockwise
/// ones; the borders are its boundary, in order.
template <class Real>
struct Body {
  std::array<Border<Real>, 6> border;
  int count = 0;
  void add(const Border<Real>& b) { border[std::size_t(count++)] = b; }
};

/// An arc as the engine sees it: counter-clockwise, in quadruple precision.
struct Course {
  Vector<quad> centre;
  quad radius;
  Vector<quad> first, last;  // unit vectors from the centre to its ends
  Index from, to;            // vertices
  double angle;              // up to 2 pi
  bool flat;                 // its chord serves: it is higher by less than what the radius is enlarged by matters
};

/// The bodies whose union is the zone of lines with arcs (docs/arcs.md).
///
/// With round caps and joins: a disk about each joint, a strip beside each segment, and for each arc one to four sectors
/// of a ring (of a disk where R exceeds the arc's radius). With others: the strips and sectors, what is beside an arc
/// beyond its centre, and a body for each bend and end.
///
/// Each body is moved as a whole by its own fixed random vector, and its radii and widths by fixed random lengths, all
/// of up to 2^-9 g (g: what the radius is enlarged by), so that no two borders coincide, touch or meet in a corner: all
/// decisions are about this instance. Where bodies belong together one reaches into the other by 2^-6 g: disks are
/// larger by that, or walls at joints are that much farther out. The sectors of one arc overlap.
class Bodies {
 public:
  /// `enlargement`: of all radii. `seed` chooses the instance. With other caps and joins than round there is one radius.
  Bodies(const CurveNetwork& network, const ShapeOptions& options, const Radii& radii, double enlargement,
         double resolution, std::uint64_t seed);

  std::size_t count() const { return specs_.size(); }
  /// In quadruple precision at the enlarged radius, moved.
  Body<quad> moved(Index body) const { return build(body, true); }
  /// At the radius as it was given, not moved: what coordinates are evaluated by.
  Body<quad> nominal(Index body) const { return build(body, false); }
  /// Holds the moved body.
  kernel::Box box(Index body) const;
  /// True if radii are too large for double precision to tell anything.
  bool is_vast(Index body) const {
    const Spec& s = specs_[body];
    return s.kind == Kind::sector && courses_[s.index].radius > vast_;
  }
  /// True if there is something beside an arc beyond its centre.
  bool go_beyond_centres() const {
    return std::any_of(specs_.begin(), specs_.end(), [](const Spec& s) { return s.kind == Kind::beyond; });
  }
  /// As it was given, of what this is a copy of.
  double radius_of(const Key& key) const;
  /// As it was given; of several the largest.
  double largest_radius() const { return radii_.most(); }
  double enlargement() const { return enlargement_; }
  /// The largest coordinate of any body.
  double scale() const { return scale_; }
  const CurveNetwork& network() const { return network_; }
  const Course& course(Index arc) const { return courses_[arc]; }
  /// The vertices that what this is a copy of ends at; none twice for what is between bodies.
  std::array<Index, 2> ends(const Key& key) const;

 private:
  enum class Kind : std::uint8_t { disk, strip, chord, sector, beyond, join, bevel, mitre, cap, square, upright };
  struct Spec {
    Kind kind;
    std::uint8_t part = 0, parts = 1;  // sectors of one arc
    Index index;                       // vertex, segment, arc or bend
  };
  /// What leaves a vertex.
  struct Arm {
    Key left, right;         // of its sides; tangent for arcs
    Vector<quad> direction;  // unit
  };
  /// The one gap above 180 degrees at a vertex: in by one arm, out by the next, the gap on the right. At an end in the
  /// same way by all.
  struct Bend {
    Index vertex;
    Vector<quad> in, out;  // directions of travel
    Key before, after;     // sides on the right of these
  };
  Body<quad> build(Index body, bool move) const;
  double radius_of(const Spec& spec) const;
  double effective(double radius) const { return radius + enlargement_; }
  void build_strip(Index a, Index b, Key key, Key end, quad width, Vector<quad> shift, bool move, Body<quad>& out) const;
  void build_sector(const Spec& spec, quad outer, quad inner, Vector<quad> shift, bool move, Body<quad>& out) const;
  void build_bend(const Spec& spec, quad radius, Vector<quad> shift, bool move, Body<quad>& out) const;
  void build_end(const Spec& spec, quad radius, Vector<quad> shift, bool move, Body<quad>& out) const;
  void list_round();
  void list_shaped();
  std::vector<std::vector<Arm>> arms() const;
  void add_bend(Index vertex, std::vector<Arm>& arms);
  void add_squares(Index vertex, const std::vector<Arm>& arms);
  quad reach(bool move) const;
  Vector<quad> at(Index vertex) const;
  Course course_of(const CurveNetwork::Arc& arc, double radius) const;
  bool ends_cover(const Course& course, double radius) const;
  bool ends_cover(Index segment) const;
  std::uint8_t parts_of(const Course& course) const;

  const ShapeOptions options_;
  const CurveNetwork& network_;
  const Radii& radii_;
  double enlargement_, resolution_, scale_, vast_, move_, excess_;
  std::uint64_t seed_;
  std::vector<Course> courses_;
  std::vector<Spec> specs_;
  std::vector<Bend> bends_;
};

}  // namespace krepl::arcs
