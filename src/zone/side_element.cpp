#include <algorithm>

#include "zone/cover.hpp"

// Formulas: engines.md, section 2, and docs/zone.md, "Closed forms". Error bounds are first-order with a factor of two to
// eight to spare: r below is the relative error of the frame, e the error of a coordinate in it.

namespace krepl::zone {

using kernel::absolute;
using kernel::square_root;

template <class Real>
struct SideSite {
  Vector<Real> a, d, b;  // ends and their difference, in the frame
  Index site, vertex_a, vertex_b;
  Real radius;           // of the cigar
  Real coordinate_error;
  Real span;             // |d|
  Real d_error;          // of d.x and d.y
  Real cosine;           // d.x / |d|
  Real cosine_error;
  Real rise;             // |d.y|
  int sigma;             // sign of d.y
};

template <class Real>
SideElement<Real>::SideElement(const Instance& instance, Index element)
    : instance_(instance), element_(element), ends_(instance.ends(element)) {
  const Vector<Real> d = instance.difference<Real>(ends_.to, ends_.from);
  length_ = length(d);
  u_ = {d.x / length_, d.y / length_};
  radius_ = instance.radius_of(element);
  unseen_ = instance.unseen_move<Real>();
  relative_error_ = Real(16 * kernel::unit_roundoff<Real>) + 8 * unseen_ / length_;
  start_label_ = instance.sector(ends_.from).after == element ? instance.circle(ends_.from) : none;
  end_label_ = instance.sector(ends_.to).before == element ? instance.circle(ends_.to) : none;
}

template <class Real>
Vector<Real> SideElement<Real>::locate(Index vertex) const {
  const Vector<Real> v = rotate(instance_.difference<Real>(vertex, ends_.from));
  return {v.x, v.y - radius_};
}

/// The cut of the disk about a vertex with y = 0. False if there certainly is none.
template <class Real>
bool SideElement<Real>::add_disc(Covers<Real>& out, Index vertex, Index site) const {
  const Vector<Real> q = locate(vertex);
  const Real r = instance_.site_radius(site);
  const Real e = relative_error_ * (absolute(q.x) + absolute(q.y) + std::max(radius_, r)) + 4 * unseen_;
  const Real square = (r - q.y) * (r + q.y);
  const Real square_error = 8 * r * e;
  if (square < -square_error) return false;
  const bool certain = square > 4 * square_error;
  const Real half = square_root(std::max<Real>(square, 0));
  const Real error = certain ? e + square_error / half : 3 * square_root(absolute(square) + square_error) + e;
  const Index label = instance_.circle(vertex);
  out.add({{q.x - half, error, label, certain}, {q.x + half, error, label, certain}, site});
  return true;
}

/// One end of the cut of a cigar with y = 0: the largest (direction +1) or smallest (-1) u. The offset line with the normal on
/// that side crosses y = 0 over the place t = numerator / rise of the segment; beyond its ends the disk there takes over.
template <class Real>
bool SideElement<Real>::add_end(CoverEnd<Real>& end, Real numerator, Real numerator_error, int direction,
                                const SideSite<Real>& s) const {
  const Real e = s.coordinate_error;
  bool certain = absolute(numerator) > numerator_error && absolute(numerator - s.rise) > numerator_error + s.d_error;
  if (s.rise <= s.d_error) {  // the sign of d.y is unknown: both numerators must decide alike
    certain = certain && s.radius * absolute(s.cosine) - absolute(s.a.y) > numerator_error + s.rise + s.d_error;
  }
  if (numerator > 0 && numerator < s.rise) {
    const Real t = numerator / s.rise;
    const Real reach = s.radius * s.rise / s.span;
    end.at = s.a.x + t * s.d.x + direction * reach;
    end.error = e + s.radius * s.cosine_error + absolute(s.d.x) * (numerator_error + t * s.d_error) / s.rise + s.d_error;
    // Right of b -> a has the normal (d.y, -d.x) in this reflected frame.
    end.label = 2 * s.site + Index((direction > 0) == (s.sigma > 0));
    end.label_certain = certain;
    return true;
  }
  const bool at_a = numerator <= 0;
  const Vector<Real> q = at_a ? s.a : s.b;
  const Real square = (s.radius - q.y) * (s.radius + q.y);
  const Real square_error = 8 * s.radius * e;
  if (square < -square_error && certain) return false;
  if (square > 4 * square_error) {
    const Real half = square_root(square);
    end.at = q.x + direction * half;
    end.error = e + square_error / half;
  } else {
    end.at = q.x + direction * square_root(std::max<Real>(square, 0));
    end.error = 3 * square_root(absolute(square) + square_error) + e;
    certain = false;
  }
  if (!certain) {  // the touching point may lie inside the segment, as far as the errors allow
    const Real part = s.rise > 0 ? std::min<Real>(1, (numerator_error + s.d_error) / s.rise) : Real(1);
    end.error += (absolute(s.d.x) + s.radius) * part;
  }
  end.label = instance_.circle(at_a ? s.vertex_a : s.vertex_b);
  end.label_certain = certain;
  return true;
}

/// A segment that shares an end with the element's own: the general formula would subtract R from R there. It covers the
/// element from the shared end up to T = R / tan(half the angle between the two), if it turns to the element's side.
template <class Real>
void SideElement<Real>::add_incident(Covers<Real>& out, Index site, bool at_end, Index other) const {
  const Index shared = at_end ? ends_.to : ends_.from;
  Vector<Real> d = rotate(instance_.difference<Real>(other, shared));
  if (!at_end) d.x = -d.x;  // mirrored: the element's own segment now leaves the shared end towards -u
  const Real span = length(d);
  const Real e = relative_error_ * span + 4 * unseen_;
  if (d.y < -e) return;
  // One of these exists, or the end would be convex: which one, the nearest sector neighbour, decides the caller.
  const bool forward = d.x > 0;
  Real t, error;
  bool certain = true;
  if (forward) {
    t = radius_ * d.y / (span + d.x);
    error = 4 * radius_ * e / (span + d.x) + Real(8 * kernel::unit_roundoff<Real>) * absolute(t);
  } else if (d.y > 4 * e) {
    t = radius_ * (span - d.x) / d.y;
    error = t * 4 * (e / d.y + Real(4 * kernel::unit_roundoff<Real>));
  } else {  // folded back onto the element's segment: it covers all up to its far end, or nothing
    t = span + radius_;
    error = 2 * (span + radius_);
    certain = false;
  }
  if (d.y <= e) certain = certain && forward;
  Index label;
  if (t < span) {
    // The side of the neighbour that faces the element: right of shared -> other at the end, of other -> shared at the start.
    const Index along = instance_.site(site).a == shared ? 2 * site : 2 * site + 1;
    label = at_end ? along : along ^ 1u;
    certain = certain && span - t > error + e;
  } else {
    label = instance_.circle(other);
    certain = certain && t - span > error + e;
    if (d.y > 4 * e || forward) {
      const Real y = d.y - radius_;
      const Real square = d.y * (2 * radius_ - d.y);
      const Real square_error = 8 * radius_ * e + 8 * absolute(y) * e;
      const Real half = square_root(std::max<Real>(square, 0));
      t = half - d.x;
      if (square > 4 * square_error) {
        error = (certain ? Real(0) : error) + 2 * e + square_error / half;
      } else {
        error = error + 2 * (half + square_root(square_error)) + e;
        certain = false;
      }
    }
  }
  const Real far = 4 * (length_ + radius_ + span) + error;  // beyond the shared end, out of the element
  if (at_end) {
    out.add({{length_ - t, error + end_error(), label, certain}, {length_ + far, Real(0), none, true}, site});
  } else {
    out.add({{-far, Real(0), none, true}, {t, error, label, certain}, site});
  }
}

template <class Real>
Covers<Real> SideElement<Real>::covered_by(Index site) const {
  Covers<Real> out;
  const auto ends = instance_.site(site);
  const bool a_start = ends.a == ends_.from, a_end = ends.a == ends_.to;
  const bool b_start = ends.b == ends_.from, b_end = ends.b == ends_.to;
  if (a_start || a_end || b_start || b_end) {
    if ((a_start || a_end) && (b_start || b_end)) return out;  // the element's own segment
    const bool at_end = a_end || b_end;
    // At a convex end every other segment turns away.
    if ((at_end ? end_label_ : start_label_) != none) return out;
    add_incident(out, site, at_end, (a_start || a_end) ? ends.b : ends.a);
    return out;
  }
  if (ends.a == ends.b) {
    add_disc(out, ends.a, site);
    return out;
  }
  SideSite<Real> s;
  s.site = site;
  s.vertex_a = ends.a;
  s.vertex_b = ends.b;
  s.radius = instance_.site_radius(site);
  s.a = locate(ends.a);
  s.b = locate(ends.b);
  s.d = rotate(instance_.difference<Real>(ends.b, ends.a));
  const Real size = absolute(s.a.x) + absolute(s.a.y) + absolute(s.b.x) + absolute(s.b.y) + 2 * std::max(radius_, s.radius);
  const Real e = relative_error_ * size + 4 * unseen_;
  s.coordinate_error = e;
  const Real r = s.radius;
  if ((s.a.y > r + e && s.b.y > r + e) || (s.a.y < -r - e && s.b.y < -r - e)) return out;
  s.span = length(s.d);
  s.d_error = relative_error_ * s.span + 2 * unseen_;
  s.cosine = s.d.x / s.span;
  s.cosine_error = 4 * s.d_error / s.span;
  s.rise = absolute(s.d.y);
  s.sigma = s.d.y >= 0 ? 1 : -1;
  const Real numerator_error = r * s.cosine_error + e;
  const Real shift = s.sigma * s.a.y;
  Cover<Real> cover;
  cover.site = site;
  if (!add_end(cover.high, r * s.cosine - shift, numerator_error, +1, s)) return out;
  if (!add_end(cover.low, -r * s.cosine - shift, numerator_error, -1, s)) return out;
  out.add(cover);
  return out;
}

template class SideElement<double>;
template class SideElement<quad>;

}  // namespace krepl::zone
