#pragma once

#include <algorithm>
#include <vector>

#include "arcs/bodies.hpp"

namespace krepl::arcs {

/// A stretch of a border's parameter that a body covers, and by which of the body's borders each end is met.
template <class Real>
struct Stretch {
  Real low, high;
  int low_border, high_border;  // -1: the border's own end
};

/// The places of a border by a parameter: along a line from 0 to 1, on an arc the diamond angle from its start, the way
/// it runs.
template <class Real>
class Path {
 public:
  explicit Path(const Border<Real>& border) : b_(border), sense_(border.clockwise ? -1 : 1) {
    d_ = {b_.q.x - b_.p.x, b_.q.y - b_.p.y};
    if (!b_.arc) return;
    const Vector<Real> u{b_.p.x - b_.c.x, b_.p.y - b_.c.y};
    const Real l = length(u);
    u_ = {u.x / l, u.y / l};
    end_ = b_.p.x == b_.q.x && b_.p.y == b_.q.y ? Real(4) : angle({b_.q.x - b_.c.x, b_.q.y - b_.c.y});
  }
  Real end() const { return end_; }
  Vector<Real> at(Real t) const {
    if (!b_.arc) return {b_.p.x + t * d_.x, b_.p.y + t * d_.y};
    const Real x = t < 2 ? 1 - t : t - 3, y = sense_ * (t < 1 ? t : t < 3 ? 2 - t : t - 4);
    const Real scale = b_.radius / kernel::square_root(x * x + y * y);
    return {b_.c.x + (u_.x * x - u_.y * y) * scale, b_.c.y + (u_.y * x + u_.x * y) * scale};
  }

  /// What of the border is in the body, grown by `grown`; appended to `out`.
  void covered_by(const Body<Real>& body, Real grown, std::vector<Stretch<Real>>& out) const {
    const std::size_t first = out.size();
    out.push_back({Real(0), end_, -1, -1});
    for (int k = 0; k < body.count && out.size() > first; ++k) {
      const Border<Real>& border = body.border[std::size_t(k)];
      if (!border.arc) {
        cut_by_line(border, grown, k, first, out);
      } else if (b_.arc) {
        cut_arc_by_circle(border, border.clockwise ? border.radius - grown : border.radius + grown, k, first, out);
      } else {
        cut_line_by_circle(border, border.clockwise ? border.radius - grown : border.radius + grown, k, first, out);
      }
    }
  }

 private:
  /// From the start, the way the arc runs, in [0, 4).
  Real angle(Vector<Real> v) const {
    const Vector<Real> w{v.x * u_.x + v.y * u_.y, sense_ * (v.y * u_.x - v.x * u_.y)};
    const Real d = w.y / (kernel::absolute(w.x) + kernel::absolute(w.y));
    if (w.x < 0) return 2 - d;
    return d < 0 ? 4 + d : d;
  }
  static void drop_empty(std::size_t first, std::vector<Stretch<Real>>& out) {
    const auto empty = [](const Stretch<Real>& s) { return !(s.low < s.high); };
    out.erase(std::remove_if(out.begin() + std::ptrdiff_t(first), out.end(), empty), out.end());
  }
  static void keep(Real low, Real high, int k, std::size_t first, std::vector<Stretch<Real>>& out) {
    for (std::size_t i = first; i < out.size(); ++i) {
      if (low > out[i].low) out[i].low = low, out[i].low_border = k;
      if (high < out[i].high) out[i].high = high, out[i].high_border = k;
    }
    drop_empty(first, out);
  }
  /// What is not between the two, low < high.
  static void keep_outside(Real low, Real high, int k, std::size_t first, std::vector<Stretch<Real>>& out) {
    const std::size_t count = out.size();
    for (std::size_t i = first; i < count; ++i) {
      if (high < out[i].high) {
        Stretch<Real> late = out[i];
        if (high > late.low) late.low = high, late.low_border = k;
        out.push_back(late);
      }
      if (low < out[i].high) out[i].high = low, out[i].high_border = k;
    }
    drop_empty(first, out);
  }
  /// Angles from low on to high, which may run over the start.
  static void keep_angles(Real low, Real high, int k, std::size_t first, std::vector<Stretch<Real>>& out) {
    if (low <= high) return keep(low, high, k, first, out);
    keep_outside(high, low, k, first, out);
  }
  void cut_by_line(const Border<Real>& line, Real grown, int k, std::size_t first,
                   std::vector<Stretch<Real>>& out) const {
    const Vector<Real> e = line.q - line.p;
    const Real l = length(e);
    const auto depth = [&](Vector<Real> p) { return cross(e, p - line.p) / l + grown; };
    if (b_.arc) return cut_by_cap({-e.y / l, e.x / l}, -depth(b_.c) / b_.radius, false, k, first, out);
    const Real from = depth(b_.p), slope = cross(e, d_) / l;
    if (slope > 0) return keep(-from / slope, end_ + 1, k, first, out);
    if (slope < 0) return keep(Real(-1), -from / slope, k, first, out);
    if (!(from > 0)) out.resize(first);
  }
  /// What of the arc lies where u.m >= c, u the unit vector from its centre; or, `outside`, where it is less.
  void cut_by_cap(Vector<Real> m, Real c, bool outside, int k, std::size_t first,
                  std::vector<Stretch<Real>>& out) const {
    if (c <= -1 || c >= 1) {
      if ((c >= 1) != outside) out.resize(first);
      return;
    }
    cut_by_cap(m, c, kernel::square_root((1 - c) * (1 + c)), outside, k, first, out);
  }
  /// The same where the circles certainly meet, s the sine to the cosine c, however near 1 that is.
  void cut_by_cap(Vector<Real> m, Real c, Real s, bool outside, int k, std::size_t first,
                  std::vector<Stretch<Real>>& out) const {
    Real low = angle({c * m.x + s * m.y, c * m.y - s * m.x}), high = angle({c * m.x - s * m.y, c * m.y + s * m.x});
    if (b_.clockwise != outside) std::swap(low, high);
    keep_angles(low, high, k, first, out);
  }
  void cut_line_by_circle(const Border<Real>& circle, Real r, int k, std::size_t first,
                          std::vector<Stretch<Real>>& out) const {
    const Real l = length(d_);
    const Vector<Real> w{d_.x / l, d_.y / l}, v = circle.c - b_.p;
    const Real along = dot(v, w), off = cross(w, v), square = r > 0 ? (r - off) * (r + off) : Real(-1);
    if (!(square > 0)) {
      if (!circle.clockwise) out.resize(first);
      return;
    }
    const Real half = kernel::square_root(square);
    if (circle.clockwise) return keep_outside((along - half) / l, (along + half) / l, k, first, out);
    keep((along - half) / l, (along + half) / l, k, first, out);
  }
  void cut_arc_by_circle(const Border<Real>& circle, Real r, int k, std::size_t first,
                         std::vector<Stretch<Real>>& out) const {
    const Vector<Real> v = circle.c - b_.c;
    const Real l = length(v), own = b_.radius;
    if (!(l > 0) || !(r > 0)) {
      if ((r > own) == circle.clockwise) out.resize(first);
      return;
    }
    // |u own - v| <= r. 1 - c and 1 + c as products do not cancel where the circles nearly touch.
    const Real below = (r - own + l) * (r + own - l), above = (own + l - r) * (own + l + r), whole = 2 * own * l;
    if (!(below > 0) || !(above > 0)) {
      // below <= 0: the circles are apart, or this one holds the other: nothing of it inside. Else all of it is.
      if (!(below > 0) != circle.clockwise) out.resize(first);
      return;
    }
    const Real c = (own * own - r * r + l * l) / whole;
    cut_by_cap({v.x / l, v.y / l}, c, kernel::square_root(below * above) / whole, circle.clockwise, k, first, out);
  }

  const Border<Real>& b_;
  Real sense_;
  Vector<Real> d_, u_{};
  Real end_ = 1;
};

}  // namespace krepl::arcs
