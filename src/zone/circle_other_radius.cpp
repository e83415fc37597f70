// A circle against a cigar of another radius: the only pair that can meet in two intervals (engines.md, section 2).
//
// What the two share is told by signs alone: which of the four joints of the cigar's border (where its sides end in its
// caps) lie inside the circle, and whether a stretch between two joints on the same side dips over the circle and back.
// So neighbouring stretches cannot contradict each other, however the numbers round.
#include <algorithm>
#include <array>

#include "zone/cover.hpp"

namespace krepl::zone {

using kernel::absolute;
using kernel::square_root;

namespace {


/// Where the circle crosses the cigar's border.
template <class Real>
struct Event {
  CoverEnd<Real> end;
  bool enters;  // the circle, counter-clockwise, enters the cigar
};

/// A circle about the origin against cigars of radius r; everything in the frame of the circle element.
template <class Real>
class OtherRadius {
 public:
  OtherRadius(Real radius, Real cigar_radius, Real frame_error)
      : radius_(radius), cigar_(cigar_radius), frame_error_(frame_error) {}

  struct Cap {
    Vector<Real> centre, outward;  // outward: away from the segment; zero for a whole disk
    Real error;                    // of a coordinate
    Index label;
  };

  void add_side(Vector<Real> m, Real h, Real h_error, Real m_error, Real start, Real end, bool first_inside,
                bool last_inside, Index label);
  void add_cap(const Cap& cap, bool first_inside, bool last_inside);
  void add_disk(const Cap& cap) { add_cap(cap, false, false); }

  /// Whether a point is inside the circle.
  bool inside(Vector<Real> p, Real error) {
    const Real off = length(p) - radius_;
    if (absolute(off) <= error) uncertain_ = true;
    return off < 0;
  }
  /// The crossings in counter-clockwise order; precondition: is_certain() or nothing better is to be had.
  const std::array<Event<Real>, 8>& sorted() {
    for (int i = 1; i < count_; ++i) {  // a handful
      for (int k = i; k > 0 && events_[k].end.at < events_[k - 1].end.at; --k) std::swap(events_[k], events_[k - 1]);
    }
    for (int i = 0; i < count_; ++i) {
      const Event<Real>&e = events_[i], &f = events_[(i + 1) % count_];
      if (e.enters == f.enters) uncertain_ = true;
      const Real gap = i + 1 < count_ ? f.end.at - e.end.at : f.end.at + 4 - e.end.at;
      if (gap <= e.end.error + f.end.error) uncertain_ = true;
    }
    if (count_ > 4) uncertain_ = true;
    return events_;
  }
  int count() const { return count_; }
  bool is_certain() const { return !uncertain_; }

 private:
  static constexpr double roundoff = kernel::unit_roundoff<Real>;

  void add(Real c, Vector<Real> axis, int sign, Real square, Real square_error, Real axis_error, Index label, bool enters);

  Real radius_, cigar_, frame_error_;
  std::array<Event<Real>, 8> events_;
  int count_ = 0;
  bool uncertain_ = false;
};

/// The crossing at c axis + sign sqrt(square) axis', axis' left of the unit vector `axis`, square = 1 - c^2.
template <class Real>
void OtherRadius<Real>::add(Real c, Vector<Real> axis, int sign, Real square, Real square_error, Real axis_error,
                            Index label, bool enters) {
  const Real s = square_root(std::max<Real>(square, 0));
  Event<Real>& e = events_[count_++];
  e.end.at = diamond_angle(Vector<Real>{c * axis.x - sign * s * axis.y, c * axis.y + sign * s * axis.x});
  const bool clear = square > 4 * square_error;
  if (!clear) uncertain_ = true;
  e.end.error = 2 * (clear ? square_error / s : 2 * square_root(absolute(square) + square_error)) + 2 * axis_error + frame_error_;
  e.end.label = label;
  e.end.label_certain = true;
  e.enters = enters;
}

/// A side with the outward normal m, at the signed distance h from the origin, between two places along it (left of m).
/// Whether its first and its last joint are inside the circle is known.
template <class Real>
void OtherRadius<Real>::add_side(Vector<Real> m, Real h, Real h_error, Real m_error, Real start, Real end,
                                 bool first_inside, bool last_inside, Index label) {
  if (first_inside && last_inside) return;
  const Real square = (radius_ - h) * (radius_ + h) / (radius_ * radius_);
  const Real square_error = 4 * h_error / radius_ + Real(8 * roundoff);
  if (!first_inside && !last_inside) {
    if (square < -square_error || end <= -h_error || start >= h_error) return;
    if (absolute(square) <= square_error || start >= -h_error || end <= h_error) uncertain_ = true;
    if (square <= 0 || start >= 0 || end <= 0) return;
  }
  const Real k = h / radius_;
  if (!first_inside) add(k, m, -1, square, square_error, m_error, label, false);
  if (!last_inside) add(k, m, +1, square, square_error, m_error, label, true);
}

/// A cap (or a whole disk) whose first and last joint are inside the circle or not.
template <class Real>
void OtherRadius<Real>::add_cap(const Cap& cap, bool first_inside, bool last_inside) {
  const Vector<Real> q = cap.centre;
  const Real distance = length(q), e = cap.error;
  // The circles cross if a triangle has these sides; 1 - c^2 of the angle at the origin is a product of its defects.
  const Real apart = cigar_ + radius_ - distance, around = cigar_ + distance - radius_, within = distance + radius_ - cigar_;
  const Real least = std::min({apart, around, within});
  const bool dips = first_inside == last_inside;
  if (dips) {
    if (least < -e) return;
    const Real facing = dot(q, cap.outward);  // a dip over the circle is about the cap's place nearest or furthest
    const Real across = first_inside ? facing : -facing;
    const bool whole = cap.outward.x == 0 && cap.outward.y == 0;
    if (!whole && across < -e) return;
    if (least <= e || (!whole && across <= e)) uncertain_ = true;
    if (least <= 0 || (!whole && across <= 0)) return;
  }
  const Vector<Real> u{q.x / distance, q.y / distance};
  const Real c = (distance + (radius_ - cigar_) * (radius_ + cigar_) / distance) / (2 * radius_);
  const Real scale = 4 * distance * distance * radius_ * radius_;
  const Real square = apart * around * within * (distance + radius_ + cigar_) / scale;
  const Real ratio = absolute(radius_ - cigar_) * (radius_ + cigar_) / (distance * distance);
  const Real c_error = e / radius_ * (1 + ratio) + Real(8 * roundoff);
  const Real axis_error = 4 * e / distance;
  // Where the cigar's border comes out of the circle, the circle enters the cigar.
  if (dips || first_inside) add(c, u, -1, square, 4 * c_error, axis_error, cap.label, true);
  if (dips || last_inside) add(c, u, +1, square, 4 * c_error, axis_error, cap.label, false);
}

}  // namespace

/// In double precision: tells nothing, so that quadruple precision decides. There: covers nothing.
template <class Real>
void CircleElement<Real>::add_undecided(Covers<Real>& out, Index site) const {
  out.add({{Real(0), Real(16), 2 * site, false}, {Real(0), Real(16), 2 * site, false}, site});
}

template <class Real>
void CircleElement<Real>::add_other_radius(Covers<Real>& out, Index site) const {
  const auto ends = instance_.site(site);
  const Real r = instance_.site_radius(site);
  const Real rounding = Real(16 * kernel::unit_roundoff<Real>);
  const Vector<Real> a = rotate(instance_.difference<Real>(ends.a, vertex_));
  const Vector<Real> b = rotate(instance_.difference<Real>(ends.b, vertex_));
  const Real size = absolute(a.x) + absolute(a.y) + absolute(b.x) + absolute(b.y) + r + radius_;
  Real e = rounding * size + 4 * unseen_;
  OtherRadius<Real> crossings(radius_, r, frame_error_);
  bool around;  // the origin is inside the cigar
  bool joints_outside = true;
  if (ends.a == ends.b) {
    crossings.add_disk({a, {0, 0}, e, instance_.circle(ends.a)});
    around = length(a) < r;
    joints_outside = length(a) + r > radius_;
  } else {
    const Vector<Real> d = rotate(instance_.difference<Real>(ends.b, ends.a));
    const Real span = length(d);
    const Real d_error = 2 * (rounding + 2 * unseen_ / span);
    const Vector<Real> along{d.x / span, d.y / span}, left{-along.y, along.x};
    // The line by its nearer end, whose place turns less with an error of the direction.
    const bool by_a = dot(a, a) <= dot(b, b);
    const Vector<Real> near = by_a ? a : b;
    const Real o = dot(near, left);
    const Real h_error = e + d_error * (length(near) + r);
    if (absolute(o) - r > radius_ + h_error) return;
    const Real ta = by_a ? dot(a, along) : dot(b, along) - span, tb = by_a ? ta + span : dot(b, along);
    if (ta - r > radius_ + h_error || tb + r < -radius_ - h_error) return;
    e = h_error + d_error * span;
    const auto inside = [&](Vector<Real> end, int side) {
      return crossings.inside({end.x + side * r * left.x, end.y + side * r * left.y}, e);
    };
    const bool right_a = inside(a, -1), right_b = inside(b, -1), left_a = inside(a, +1), left_b = inside(b, +1);
    const Vector<Real> right{-left.x, -left.y}, back{-along.x, -along.y};
    crossings.add_side(right, r - o, e, d_error, ta, tb, right_a, right_b, 2 * site);
    crossings.add_cap({b, along, e, instance_.circle(ends.b)}, right_b, left_b);
    crossings.add_side(left, o + r, e, d_error, -tb, -ta, left_b, left_a, 2 * site + 1);
    crossings.add_cap({a, back, e, instance_.circle(ends.a)}, left_a, right_a);
    around = (absolute(o) < r && ta < 0 && tb > 0) || length(a) < r || length(b) < r;
    joints_outside = !right_a && !right_b && !left_a && !left_b;
  }
  const auto& events = crossings.sorted();
  if (!crossings.is_certain() && (unseen_ > 0 || crossings.count() > 4)) {
    add_undecided(out, site);
    return;
  }
  const int count = crossings.count();
  if (count == 0 && around && joints_outside) {
    out.add({{Real(-16), Real(0), none, true}, {Real(16), Real(0), none, true}, site});
  }
  for (int i = 0; i < count; ++i) {
    if (!events[i].enters) continue;
    clip(out, {events[i].end, events[(i + 1) % count].end, site});
  }
}

template void CircleElement<double>::add_undecided(Covers<double>&, Index) const;
template void CircleElement<quad>::add_undecided(Covers<quad>&, Index) const;
template void CircleElement<double>::add_other_radius(Covers<double>&, Index) const;
template void CircleElement<quad>::add_other_radius(Covers<quad>&, Index) const;

}  // namespace krepl::zone
