#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "verify/obstacle.hpp"

namespace krepl::verify {

/// The shape that a zone was asked to have.
struct ShapeQuestion {
  enum class Cap : std::uint8_t { round, flat, square };
  enum class Join : std::uint8_t { round, mitre, bevel };
  enum class Side : std::uint8_t { both, left, right };
  double distance = 0;  ///< negative: polygons shrunk
  Cap cap = Cap::round;
  Join join = Join::round;
  double mitre_limit = 5;
  Side side = Side::both;
  bool ring = false;
};

/// Tells by brute force, from the definition alone, whether a place belongs to a zone of some shape: by rectangles
/// beside segments, joins and caps one by one, or by the nearest segments and the side they are seen from.
class ShapeOracle {
 public:
  enum class Answer { inside, outside, unclear };

  ShapeOracle(const std::vector<InputPart>& parts, const Obstacle& obstacle, const ShapeQuestion& question);

  /// Whether p is inside, by the definition and no tolerance.
  bool holds(Vec p) const;
  /// What is so all around p at that distance and in p itself; unclear if some places there are inside and some not.
  Answer around(Vec p, Real distance) const;

 private:
  struct Corner {
    Vec at;
    std::vector<Vec> arms;      // directions of what leaves it, in counter-clockwise order
    std::vector<bool> out, in;  // per arm: some line runs along it away from the corner, towards it
    std::vector<Real> gap;      // per arm: counter-clockwise angle to the next one
    bool end = false;           // all arms leave in one direction
    Box box() const {
      Box b;
      b.add(at);
      return b;
    }
    Real distance(Vec p) const { return verify::distance(p, at); }
  };
  struct Side {
    Vec a, b;
    std::shared_ptr<const CircularArc> arc;  // null: straight
    bool end_a = false, end_b = false;           // a line ends there
    bool forward = false, backward = false;      // lines run from a to b, from b to a
    Box box() const {
      if (arc) return arc->box();
      Box r;
      r.add(a), r.add(b);
      return r;
    }
    Real distance(Vec p) const { return arc ? arc->distance(p) : distance_to_segment(p, a, b); }
  };
  /// How deep a place lies in a body: within its outer borders, and between the walls that other bodies go on behind.
  struct Depth {
    Real outer, walls;
  };

  struct Picture {
    std::vector<Corner> corners;
    std::vector<Side> sides;
  };
  static Picture picture_of(const std::vector<InputPart>& parts, bool border_only);
  ShapeOracle(Picture picture, const Obstacle& obstacle, const ShapeQuestion& question);
  Depth in_rectangle(const Side& s, Vec p) const;
  void in_arc(const Side& s, Vec p, std::vector<Depth>& out) const;
  void in_corner(const Corner& c, Vec p, std::vector<Depth>& out) const;
  bool zone_holds(Vec p) const;
  bool side_holds(Vec p) const;
  /// True if a place in that direction from the corner is on the asked-for side of the lines there.
  bool on_side(const Corner& c, Vec direction) const;

  const Obstacle& obstacle_;
  ShapeQuestion question_;
  Real radius_, reach_;
  NearestTree<Corner> corners_;
  NearestTree<Side> sides_;
};

}  // namespace krepl::verify
