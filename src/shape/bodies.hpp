#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "krepl/shape.hpp"
#include "zone/instance.hpp"

namespace krepl::shape {

using kernel::quad;
using zone::Index;
using zone::none;
template <class Real>
using Vector = zone::Vector<Real>;

/// What a border of a body is a copy of: borders of several bodies may lie on one offset line.
struct Key {
  enum class Kind : std::uint8_t { side, circle, end, bevel };
  Kind kind;
  Index index;             // of the side as zone::Instance counts them; or of the vertex
  std::uint8_t which = 0;  // ends: a vertex may have several
  friend bool operator==(const Key&, const Key&) = default;
};

/// A straight border from p to q with the body on its left, or a counter-clockwise arc about c from p to q (p == q: the
/// full circle).
template <class Real>
struct Border {
  bool arc = false;
  Vector<Real> p, q, c;
  Key key;
};

/// A convex body: the places on the left of all its straight borders and within all its circles.
template <class Real>
struct Body {
  std::array<Border<Real>, 6> border;
  int count = 0;
  void add(const Border<Real>& b) { border[std::size_t(count++)] = b; }
};

/// The convex bodies whose union is the zone of a network's lines and points (docs/shape.md, "Bodies"): a rectangle for
/// each segment, and at vertices joins, caps and, where lines go straight on, a body that covers the seam.
///
/// Bodies overlap by more than the perturbation wherever the union is not to show a border. Each corner of each body is
/// moved by a fixed random vector of up to 2^-62 of the scale, so that no two borders coincide, touch or meet in a
/// corner: all decisions are about this instance.
class Bodies {
 public:
  Bodies(const Network& network, const zone::Instance& instance, const ShapeOptions& options);

  std::size_t count() const { return specs_.size(); }
  /// In quadruple precision at the enlarged radius, moved.
  Body<quad> moved(Index body) const { return build(body, radius_, true); }
  /// In quadruple precision at the radius as it was given: what coordinates are evaluated by.
  Body<quad> nominal(Index body) const { return build(body, nominal_radius_, false); }
  double radius() const { return radius_; }
  double nominal_radius() const { return nominal_radius_; }
  /// The largest coordinate of any body.
  double scale() const { return scale_; }

 private:
  enum class Kind : std::uint8_t { rectangle, join, bevel, mitre, cap, disc, square, seam };
  struct Spec {
    Kind kind;
    bool folded = false;  // a cap: the side after runs back along the side before
    Index a;              // rectangle: the segment; joins: the side before; else the vertex
    Index b = none;       // joins: the side after; seams: the second side
    double overlap = 0;   // how far the body reaches back along its segments
    double moves = 0;     // of its corners
  };
  struct Arm {  // a side that leaves a vertex, and its direction
    Index side;
    Vector<quad> direction;
    double length;
  };

  Body<quad> build(Index body, quad radius, bool move) const;
  void build_rectangle(const Spec& spec, quad radius, Body<quad>& out) const;
  void build_join(const Spec& spec, quad radius, Body<quad>& out) const;
  void build_point(const Spec& spec, quad radius, Body<quad>& out) const;
  void build_seam(const Spec& spec, quad radius, Body<quad>& out) const;
  void add_joins(Index vertex, const std::vector<Arm>& arms);
  void add_seams(const std::vector<Arm>& arms);
  Vector<quad> at(Index vertex) const;
  Vector<quad> direction(Index side) const;
  double length(Index side) const;
  bool is_end(Index vertex) const { return is_end_[vertex]; }

  const zone::Instance& in_;
  ShapeOptions options_;
  double radius_, nominal_radius_, scale_;
  std::vector<bool> is_end_;  // vertices: all segments leave in one direction
  std::vector<Spec> specs_;
};

}  // namespace krepl::shape
