#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "kernel/box_tree.hpp"
#include "krepl/curve_network.hpp"
#include "zone/instance.hpp"

namespace krepl::arcs {

using kernel::quad;
using Index = std::uint32_t;
inline constexpr Index none = ~Index{0};
template <class Real>
using Vector = zone::Vector<Real>;

/// What a border of a body is a copy of: the bodies of one arc share their circles.
struct Key {
  enum class Kind : std::uint8_t {
    side,    ///< index 2s: right of segment s as it runs from a to b, 2s+1: right of its reverse
    chord,   ///< the same of an arc too flat to show
    circle,  ///< about a vertex
    outer,   ///< about an arc's centre, radius r + R
    inner,   ///< about an arc's centre, radius r - R
    wall,    ///< across the end of a sector of an arc; covered by other bodies
    end      ///< across the end of a strip, at a vertex; covered by the disk there
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
};

/// The places on the left of all its straight borders, within its counter-clockwise circles and outside its clockwise
/// ones; the borders are its boundary, in order.
template <class Real>
struct Body {
  std::array<Border<Real>, 4> border;
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

/// The bodies whose union is the zone of lines with arcs (docs/arcs.md): a disk about each joint, a strip beside each
/// segment, and for each arc one to four sectors of a ring (of a disk where R exceeds the arc's radius).
///
/// Each body is moved as a whole by its own fixed random vector, and its radii and widths by fixed random lengths, all
/// of up to 2^-9 g (g: what the radius is enlarged by), so that no two borders coincide, touch or meet in a corner: all
/// decisions are about this instance. Disks are larger by 2^-6 g, so that they cover the walls at the ends of strips
/// and sectors; the sectors of one arc overlap.
class Bodies {
 public:
  /// `seed` chooses the instance.
  Bodies(const CurveNetwork& network, double nominal_radius, double effective_radius, double resolution,
         std::uint64_t seed);

  std::size_t count() const { return specs_.size(); }
  /// In quadruple precision at the enlarged radius, moved.
  Body<quad> moved(Index body) const { return build(body, effective_radius_, true); }
  /// At the radius as it was given, not moved: what coordinates are evaluated by.
  Body<quad> nominal(Index body) const { return build(body, nominal_radius_, false); }
  /// Holds the moved body.
  kernel::Box box(Index body) const;
  /// True if radii are too large for double precision to tell anything.
  bool is_vast(Index body) const {
    return specs_[body].kind == Kind::sector && courses_[specs_[body].index].radius > vast_;
  }
  double nominal_radius() const { return nominal_radius_; }
  double enlargement() const { return effective_radius_ - nominal_radius_; }
  /// The largest coordinate of any body.
  double scale() const { return scale_; }
  const CurveNetwork& network() const { return network_; }
  const Course& course(Index arc) const { return courses_[arc]; }
  /// The vertices that what this is a copy of ends at; none twice for walls and ends.
  std::array<Index, 2> ends(const Key& key) const;

 private:
  enum class Kind : std::uint8_t { disk, strip, chord, sector };
  struct Spec {
    Kind kind;
    std::uint8_t part = 0, parts = 1;  // sectors of one arc
    Index index;                       // vertex, segment or arc
  };
  Body<quad> build(Index body, quad radius, bool move) const;
  void build_strip(Index a, Index b, Key key, quad width, Vector<quad> shift, Body<quad>& out) const;
  void build_sector(const Spec& spec, quad outer, quad inner, Vector<quad> shift, Body<quad>& out) const;
  void list_bodies();
  Vector<quad> at(Index vertex) const;
  Course course_of(const CurveNetwork::Arc& arc) const;
  bool ends_cover(const Course& course) const;
  bool ends_cover(Index segment) const;

  const CurveNetwork& network_;
  double nominal_radius_, effective_radius_, resolution_, scale_, vast_, move_, excess_;
  std::uint64_t seed_;
  std::vector<Course> courses_;
  std::vector<Spec> specs_;
};

}  // namespace krepl::arcs
