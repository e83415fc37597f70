#pragma once

#include <cmath>
#include <vector>

#include "arcs/bodies.hpp"
#include "kernel/box_tree.hpp"
#include "krepl/curve_network.hpp"

namespace krepl::arcs {

/// A side of a polygon ring, or of a line, as it runs between vertices of the network: a segment or an arc.
struct RingSide {
  Index from, to;
  Index source;  ///< of the network: its segment, or its arc
  Index part;
  std::int64_t feature;
  bool from_arc = false;  ///< the source is an arc
  bool arc = false;       ///< and is too high for its chord to serve
  bool left = false;      ///< which turns left
  Index middle = none;    ///< the vertex
  Vector<quad> centre{};
  quad radius = 0;
};

/// The sides of a part, without those of no length.
void append_sides(const CurveNetwork& network, Index part, std::vector<RingSide>& out);

/// A side with its ends: how far along it and off it places are.
class SideCourse {
 public:
  SideCourse(const RingSide& side, Vector<quad> p, Vector<quad> q, bool full) : s_(side), p_(p), q_(q) {
    if (!s_.arc) {
      length_ = double(zone::length(q - p));
    } else {
      sweep_ = full ? 2 * M_PI : angle(q);
      length_ = sweep_ * double(s_.radius);
    }
  }
  double length() const { return length_; }
  /// Along the side to what is nearest to a place on its line or circle; below 0 or beyond the length outside of it.
  double along(Vector<quad> x) const {
    if (!s_.arc) return double(dot(x - p_, q_ - p_)) / length_;
    double a = angle(x);
    if (a > sweep_ / 2 + M_PI) a -= 2 * M_PI;
    return a * double(s_.radius);
  }
  /// From the line or circle.
  double off(Vector<quad> x) const {
    if (s_.arc) return std::abs(double(zone::length(x - s_.centre) - s_.radius));
    return std::abs(double(cross(q_ - p_, x - p_))) / length_;
  }
  double distance(Vector<quad> x) const {
    if (reaches(x, 0)) return off(x);
    return std::min(double(zone::length(x - p_)), double(zone::length(x - q_)));
  }
  /// True if a place on its line or circle is on it, or by no more than eps beyond its ends.
  bool reaches(Vector<quad> x, double eps) const {
    const double a = along(x);
    return a >= -eps && a <= length_ + eps;
  }
  kernel::Box box(double margin) const {
    kernel::Box box;
    box.add(Point{double(p_.x), double(p_.y)}), box.add(Point{double(q_.x), double(q_.y)});
    if (s_.arc) {
      if (sweep_ > 1) {
        box.add(Point{double(s_.centre.x - s_.radius), double(s_.centre.y - s_.radius)});
        box.add(Point{double(s_.centre.x + s_.radius), double(s_.centre.y + s_.radius)});
      }
      const double chord = double(zone::length(q_ - p_));
      if (sweep_ <= 1) margin += chord * chord / (4 * double(s_.radius));  // more than its height
    }
    return {box.min_x - margin, box.min_y - margin, box.max_x + margin, box.max_y + margin};
  }
  const RingSide& side() const { return s_; }
  Vector<quad> p() const { return p_; }
  Vector<quad> q() const { return q_; }

 private:
  double angle(Vector<quad> x) const {  // from the start the way the side runs, in [0, 2 pi)
    const Vector<quad> u = p_ - s_.centre, v = x - s_.centre;
    const double a = std::atan2(double(cross(u, v)) * (s_.left ? 1 : -1), double(dot(u, v)));
    return a < 0 ? a + 2 * M_PI : a;
  }
  const RingSide& s_;
  Vector<quad> p_, q_;
  double length_ = 0, sweep_ = 0;
};

}  // namespace krepl::arcs
