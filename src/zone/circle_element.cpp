#include <algorithm>

#include "zone/cover.hpp"

// Formulas: docs/zone.md, "Closed forms". Everything is relative to the vertex and rotated so that parameter 0 is the
// direction (1, 0); angles are diamond angles, whose error is below that of the true angle.

namespace krepl::zone {

using kernel::absolute;
using kernel::square_root;

namespace {

template <class Real>
Vector<Real> left_of(Vector<Real> v) {
  return {-v.y, v.x};
}
/// k m + s t
template <class Real>
Vector<Real> combine(Real k, Vector<Real> m, Real s, Vector<Real> t) {
  return {k * m.x + s * t.x, k * m.y + s * t.y};
}

}  // namespace

template <class Real>
CircleElement<Real>::CircleElement(const Instance& instance, Index element)
    : instance_(instance), vertex_(instance.vertex_of(element)), sector_(instance.sector(vertex_)) {
  radius_ = instance.radius_of(element);
  unseen_ = instance.unseen_move<Real>();
  const Real rounding = Real(16 * kernel::unit_roundoff<Real>);
  if (sector_.before == element) {  // an isolated vertex: the full circle
    u_ = {1, 0};
    end_ = 4;
    frame_error_ = rounding;
    return;
  }
  const auto in = instance.ends(sector_.before), out = instance.ends(sector_.after);
  const Vector<Real> d = instance.difference<Real>(in.to, in.from), f = instance.difference<Real>(out.to, out.from);
  const Real span_d = length(d), span_f = length(f);
  u_ = {d.y / span_d, -d.x / span_d};
  const Vector<Real> next = rotate(f);
  // Counter-clockwise by at most 180 degrees; rounding must not carry an end angle near 0 or 180 to the other side.
  const Vector<Real> normal{next.y, -next.x};
  end_ = diamond_angle(Vector<Real>{normal.x, std::max<Real>(normal.y, 0)});
  if (in.from == out.to) end_ = 2;
  frame_error_ = rounding + 8 * unseen_ / span_d + 8 * unseen_ / span_f;
}

/// Adds the cover's stretches that may reach the element, with parameters counted from its start.
template <class Real>
void CircleElement<Real>::clip(Covers<Real>& out, const Cover<Real>& cover) const {
  Cover<Real> c = cover;
  if (c.high.at < c.low.at) c.high.at += 4;
  for (int turn = 0; turn < 2; ++turn) {
    if (c.high.at + c.high.error > -frame_error_ && c.low.at - c.low.error < end_ + frame_error_) out.add(c);
    c.low.at -= 4;
    c.high.at -= 4;
  }
}

/// Where the circle meets the equal circle about q, counter-clockwise (direction +1) or clockwise (-1) of q: the unit vector
/// c q/|q| +- sqrt(1 - c^2) q'/|q| with c = |q| / 2R and q' left of q. False if the circles certainly do not meet.
template <class Real>
bool CircleElement<Real>::add_circle_end(CoverEnd<Real>& end, Vector<Real> q, Real error, Index vertex,
                                         int direction) const {
  const Real distance = length(q);
  const Real c = distance / (2 * radius_);
  const Real c_error = error / (2 * radius_) + 4 * Real(kernel::unit_roundoff<Real>);
  const Real square = (1 - c) * (1 + c);
  const Real square_error = 4 * c_error;
  if (square < -square_error) return false;
  const Vector<Real> unit{q.x / distance, q.y / distance};
  const Real direction_error = 4 * error / distance + frame_error_;
  end.label = instance_.circle(vertex);
  end.label_certain = square > 4 * square_error;
  if (end.label_certain) {
    const Real s = square_root(square);
    end.at = diamond_angle(combine(c, unit, direction * s, left_of(unit)));
    end.error = 2 * (c_error / s + direction_error);
  } else {
    end.at = diamond_angle(unit);
    end.error = 4 * square_root(absolute(square) + square_error) + 2 * direction_error;
  }
  return true;
}

/// A segment whose line nearly touches the circle from outside (through = false: it covers at most a sliver about m), or
/// whose inside nearly contains the vertex (through = true: it leaves at most slivers about m and -m).
template <class Real>
void CircleElement<Real>::add_nearly_touching(Covers<Real>& out, Vector<Real> m, Real width, Index site,
                                              bool through) const {
  const Real at = diamond_angle(m), opposite = diamond_angle(Vector<Real>{-m.x, -m.y});
  const Real error = 2 * width + frame_error_;
  const Index label = 2 * site;
  if (through) {
    clip(out, {{at, error, label, false}, {opposite, error, label, false}, site});
    clip(out, {{opposite, error, label, false}, {at, error, label, false}, site});
  } else {
    clip(out, {{at, error, label, false}, {at, error, label, false}, site});
  }
}

template <class Real>
Covers<Real> CircleElement<Real>::covered_by(Index site) const {
  Covers<Real> out;
  const auto ends = instance_.site(site);
  if (ends.a == vertex_ || ends.b == vertex_) return out;  // leaves the sector uncovered, by the sector's definition
  if (Real(instance_.site_radius(site)) != radius_) {
    add_other_radius(out, site);
    return out;
  }
  const Real rounding = Real(16 * kernel::unit_roundoff<Real>);
  const Vector<Real> a = rotate(instance_.difference<Real>(ends.a, vertex_));
  if (ends.a == ends.b) {
    const Real e = rounding * (absolute(a.x) + absolute(a.y)) + 4 * unseen_;
    Cover<Real> cover;
    cover.site = site;
    if (add_circle_end(cover.low, a, e, ends.a, -1) && add_circle_end(cover.high, a, e, ends.a, +1)) clip(out, cover);
    return out;
  }
  const Vector<Real> b = rotate(instance_.difference<Real>(ends.b, vertex_));
  const Vector<Real> d = rotate(instance_.difference<Real>(ends.b, ends.a));
  const Real span = length(d);
  const Real size = absolute(a.x) + absolute(a.y) + absolute(b.x) + absolute(b.y);
  const Real e = rounding * size + 4 * unseen_;
  const Real d_error = 2 * (rounding + 2 * unseen_ / span);  // relative
  const Vector<Real> along{d.x / span, d.y / span};

  // h: distance of the vertex from the line; m: unit vector from the vertex to it; t: left of m.
  const Real signed_h = along.x * a.y - along.y * a.x;
  const Real h = absolute(signed_h);
  const Real h_error = e + d_error * std::min(length(a), length(b));
  if (h > 2 * radius_ + h_error) return out;
  const bool left = signed_h >= 0;
  const Vector<Real> m = left ? left_of(along) : Vector<Real>{along.y, -along.x};
  const Vector<Real> t = left_of(m);
  const Real ta = dot(a, t), tb = dot(b, t);
  const Real t_error = e + d_error * h;

  // The near offset line cuts the circle where u.m = k, at the places +-R sqrt(1 - k^2) along t.
  const Real k = (h - radius_) / radius_;
  const Real k_error = h_error / radius_ + 4 * Real(kernel::unit_roundoff<Real>);
  const Real square = (2 * radius_ - h) * h / (radius_ * radius_);
  const bool touching = square <= 16 * k_error;
  const Real s = touching ? square_root(absolute(square) + 16 * k_error) : square_root(square);
  const Real reach = radius_ * s;
  const Real reach_error = (touching ? 2 * reach : radius_ * k_error / s * 2) + t_error;
  const Real low_t = std::min(ta, tb), high_t = std::max(ta, tb);
  if (touching) {
    const bool beyond = low_t > reach + t_error || high_t < -reach - t_error;
    const bool inside = low_t < -reach - t_error && high_t > reach + t_error;
    if (!beyond) {
      const Real anywhere = 8;  // an end of the segment is as near as the errors: this precision tells nothing
      add_nearly_touching(out, m, k < 0 && !inside ? anywhere : 2 * s, site, k < 0 && inside);
      return out;
    }
  }
  Cover<Real> cover;
  cover.site = site;
  for (const int direction : {+1, -1}) {
    CoverEnd<Real>& end = direction > 0 ? cover.high : cover.low;
    const Real contact = direction * reach;
    const bool certain = absolute(contact - ta) > reach_error && absolute(contact - tb) > reach_error;
    if (contact > low_t && contact < high_t) {
      end.at = diamond_angle(combine(k, m, direction * s, t));
      end.error = 2 * (2 * k_error / s + d_error) + frame_error_;
      end.label = 2 * site + (left ? 0u : 1u);
      end.label_certain = certain;
      continue;
    }
    // t runs against the segment where the vertex lies on the right of it: known even where ta and tb round to the same.
    const bool at_a = (contact <= low_t) != left;
    const Vector<Real> q = at_a ? a : b;
    if (!add_circle_end(end, q, rounding * (absolute(q.x) + absolute(q.y)) + 4 * unseen_, at_a ? ends.a : ends.b, direction)) {
      if (certain) return out;
      add_nearly_touching(out, m, s, site, false);
      return out;
    }
    end.label_certain = end.label_certain && certain;
    if (!certain) end.error += 4 * reach_error / radius_;
  }
  clip(out, cover);
  return out;
}

template class CircleElement<double>;
template class CircleElement<quad>;

}  // namespace krepl::zone
