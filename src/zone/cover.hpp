#pragma once

#include <array>
#include <limits>

#include "zone/instance.hpp"

namespace krepl::zone {

/// One end of a covered interval: its parameter, a bound of its error, and the boundary element met there.
template <class Real>
struct CoverEnd {
  Real at;
  Real error;
  Index label;
  bool label_certain;
};

/// The interval of an element that one site's cigar covers. Where only the error bound allows the cigar to reach the
/// element, the ends' errors are so large that nothing is certainly covered.
template <class Real>
struct Cover {
  CoverEnd<Real> low, high;
  Index site;
};

/// A circle that begins inside a covered stretch sees it at both its ends, and a cigar thinner than it in two stretches.
template <class Real>
class Covers {
 public:
  void add(const Cover<Real>& c) { items_[count_++] = c; }
  const Cover<Real>* begin() const { return items_.data(); }
  const Cover<Real>* end() const { return items_.data() + count_; }
  bool empty() const { return count_ == 0; }

 private:
  std::array<Cover<Real>, 4> items_;
  int count_ = 0;
};

template <class Real>
struct SideSite;

/// The offset line on the right of a segment, in the segment's own frame: u from its start along it, y outwards from the
/// element, so that the segment is on y = -R and the element is 0 <= u <= L on y = 0. (The frame is a reflection.)
template <class Real>
class SideElement {
 public:
  /// A stretch no longer than this lies within its chord's middle's distance to its ends and its own middle.
  static constexpr double longest_simple_stretch = std::numeric_limits<double>::infinity();

  SideElement(const Instance& instance, Index element);

  Real end() const { return length_; }
  Real end_error() const { return relative_error_ * length_; }
  /// What the element continues on at its start and end; `none` where a segment at the same vertex covers that end.
  Index start_label() const { return start_label_; }
  Index end_label() const { return end_label_; }
  /// The point at parameter u, relative to the start of the element's segment.
  Vector<Real> point(Real u) const { return {u_.x * u + u_.y * radius_, u_.y * u - u_.x * radius_}; }
  /// The vertex that point() is relative to.
  Index base() const { return ends_.from; }
  /// True for sites that cannot cover any of the element, told without arithmetic.
  bool is_own(Index site) const { return site == element_ >> 1; }
  /// The part covered by the site's cigar.
  Covers<Real> covered_by(Index site) const;

 private:
  Vector<Real> rotate(Vector<Real> v) const { return {v.x * u_.x + v.y * u_.y, v.x * u_.y - v.y * u_.x}; }
  Vector<Real> locate(Index vertex) const;
  bool add_end(CoverEnd<Real>& end, Real numerator, Real numerator_error, int direction, const SideSite<Real>& s) const;
  bool add_disc(Covers<Real>& out, Index vertex, Index site) const;
  void add_incident(Covers<Real>& out, Index site, bool at_end, Index other) const;

  const Instance& instance_;
  Index element_;
  Instance::Ends ends_;
  Vector<Real> u_;
  Real length_;
  Real radius_;
  Real relative_error_;  // of the frame: rounding and the ends' unseen move
  Real unseen_;
  Index start_label_, end_label_;
};

/// The circle about a vertex, from the end of one side counter-clockwise to the start of the next. The parameter is the
/// diamond angle in [0, 4), from the end of the first side.
template <class Real>
class CircleElement {
 public:
  static constexpr double longest_simple_stretch = 2;  // half a circle

  CircleElement(const Instance& instance, Index element);

  Real end() const { return end_; }
  Real end_error() const { return frame_error_; }
  Index start_label() const { return sector_.before; }
  Index end_label() const { return sector_.after; }
  /// The point at diamond angle d, relative to the vertex.
  Vector<Real> point(Real d) const {
    const Real x = d < 2 ? 1 - d : d - 3, y = d < 1 ? d : d < 3 ? 2 - d : d - 4;
    const Real scale = radius_ / kernel::square_root(x * x + y * y);
    return {(u_.x * x - u_.y * y) * scale, (u_.y * x + u_.x * y) * scale};
  }
  Index base() const { return vertex_; }
  bool is_own(Index site) const {
    const auto s = instance_.site(site);
    return s.a == vertex_ || s.b == vertex_;
  }
  Covers<Real> covered_by(Index site) const;

 private:
  Vector<Real> rotate(Vector<Real> v) const { return {v.x * u_.x + v.y * u_.y, v.y * u_.x - v.x * u_.y}; }
  void clip(Covers<Real>& out, const Cover<Real>& cover) const;
  bool add_circle_end(CoverEnd<Real>& end, Vector<Real> q, Real error, Index vertex, int direction) const;
  void add_nearly_touching(Covers<Real>& out, Vector<Real> m, Real width, Index site, bool through) const;
  void add_other_radius(Covers<Real>& out, Index site) const;
  void add_undecided(Covers<Real>& out, Index site) const;

  const Instance& instance_;
  Index vertex_;
  Instance::Sector sector_;
  Vector<Real> u_;  // direction of the parameter 0
  Real radius_;
  Real end_;
  Real frame_error_;
  Real unseen_;
};

/// Counter-clockwise angle of v from the x-axis, as a number in [0, 4) that needs no trigonometry; its derivative by the
/// angle is between 1/2 and 1.
template <class Real>
Real diamond_angle(Vector<Real> v) {
  const Real d = v.y / (kernel::absolute(v.x) + kernel::absolute(v.y));
  if (v.x < 0) return 2 - d;
  return d < 0 ? 4 + d : d;
}

extern template class SideElement<double>;
extern template class SideElement<quad>;
extern template class CircleElement<double>;
extern template class CircleElement<quad>;

}  // namespace krepl::zone
