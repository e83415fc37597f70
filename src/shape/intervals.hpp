#pragma once

#include <algorithm>
#include <vector>

#include "shape/bodies.hpp"

namespace krepl::shape {

/// A stretch of a border's parameter that a body covers, and by which of the body's borders each end is met.
template <class Real>
struct Stretch {
  Real low, high;
  int low_border, high_border;  // -1: the border's own end
};

/// The places of a border by a parameter: along a line from 0 to 1, on an arc the diamond angle from its start.
template <class Real>
class Course {
 public:
  Course(const Border<Real>& border, Real radius) : b_(border), radius_(radius) {
    d_ = {b_.q.x - b_.p.x, b_.q.y - b_.p.y};
    if (!b_.arc) return;
    const Vector<Real> u{b_.p.x - b_.c.x, b_.p.y - b_.c.y};
    const Real l = kernel::square_root(u.x * u.x + u.y * u.y);
    u_ = {u.x / l, u.y / l};
    end_ = b_.p.x == b_.q.x && b_.p.y == b_.q.y ? Real(4) : angle({b_.q.x - b_.c.x, b_.q.y - b_.c.y});
  }
  Real end() const { return end_; }
  Vector<Real> at(Real t) const {
    if (!b_.arc) return {b_.p.x + t * d_.x, b_.p.y + t * d_.y};
    const Real x = t < 2 ? 1 - t : t - 3, y = t < 1 ? t : t < 3 ? 2 - t : t - 4;
    const Real scale = radius_ / kernel::square_root(x * x + y * y);
    return {b_.c.x + (u_.x * x - u_.y * y) * scale, b_.c.y + (u_.y * x + u_.x * y) * scale};
  }

  /// What of the border is in the body, grown by `grown`; appended to `out`.
  void covered_by(const Body<Real>& body, Real grown, std::vector<Stretch<Real>>& out) const {
    const std::size_t first = out.size();
    out.push_back({Real(0), end_, -1, -1});
    for (int k = 0; k < body.count && out.size() > first; ++k) {
      const Border<Real>& border = body.border[std::size_t(k)];
      if (border.arc) {
        cut_by_circle(border.c, radius_ + grown, k, first, out);
      } else {
        cut_by_line(border, grown, k, first, out);
      }
    }
  }

 private:
  /// Counter-clockwise from the start, in [0, 4).
  Real angle(Vector<Real> v) const {
    const Vector<Real> w{v.x * u_.x + v.y * u_.y, v.y * u_.x - v.x * u_.y};
    const Real d = w.y / (kernel::absolute(w.x) + kernel::absolute(w.y));
    if (w.x < 0) return 2 - d;
    return d < 0 ? 4 + d : d;
  }
  static void keep(Real low, Real high, int k, std::size_t first, std::vector<Stretch<Real>>& out) {
    std::size_t to = first;
    for (std::size_t i = first; i < out.size(); ++i) {
      Stretch<Real> s = out[i];
      if (low > s.low) s.low = low, s.low_border = k;
      if (high < s.high) s.high = high, s.high_border = k;
      if (s.low < s.high) out[to++] = s;
    }
    out.resize(to);
  }
  /// An interval of angles that may run over the start.
  static void keep_angles(Real low, Real high, int k, std::size_t first, std::vector<Stretch<Real>>& out) {
    if (low <= high) return keep(low, high, k, first, out);
    const std::size_t count = out.size();
    for (std::size_t i = first; i < count; ++i) {
      const Stretch<Real> s = out[i];
      if (low < s.high) {
        Stretch<Real> late = s;
        if (low > s.low) late.low = low, late.low_border = k;
        out.push_back(late);
      }
      out[i].high = s.high;
      if (high < s.high) out[i].high = high, out[i].high_border = k;
    }
    std::size_t to = first;
    for (std::size_t i = first; i < out.size(); ++i)
      if (out[i].low < out[i].high) out[to++] = out[i];
    out.resize(to);
  }
  void cut_by_line(const Border<Real>& line, Real grown, int k, std::size_t first,
                   std::vector<Stretch<Real>>& out) const {
    const Vector<Real> e{line.q.x - line.p.x, line.q.y - line.p.y};
    const Real l = kernel::square_root(e.x * e.x + e.y * e.y);
    const auto depth = [&](Vector<Real> p) { return (e.x * (p.y - line.p.y) - e.y * (p.x - line.p.x)) / l + grown; };
    if (!b_.arc) {
      const Real from = depth(b_.p), slope = (e.x * d_.y - e.y * d_.x) / l;
      if (slope > 0) return keep(-from / slope, end_ + 1, k, first, out);
      if (slope < 0) return keep(Real(-1), -from / slope, k, first, out);
      if (!(from > 0)) out.resize(first);
      return;
    }
    const Vector<Real> inward{-e.y / l, e.x / l};
    cut_by_cap(inward, -depth(b_.c) / radius_, k, first, out);
  }
  /// What of an arc lies where u.m >= c, u the unit vector from its centre.
  void cut_by_cap(Vector<Real> m, Real c, int k, std::size_t first, std::vector<Stretch<Real>>& out) const {
    if (c <= -1) return;
    if (c >= 1) return out.resize(first);
    const Real s = kernel::square_root((1 - c) * (1 + c));
    keep_angles(angle({c * m.x + s * m.y, c * m.y - s * m.x}), angle({c * m.x - s * m.y, c * m.y + s * m.x}), k, first,
                out);
  }
  void cut_by_circle(Vector<Real> c, Real r, int k, std::size_t first, std::vector<Stretch<Real>>& out) const {
    if (!b_.arc) {
      const Real l = kernel::square_root(d_.x * d_.x + d_.y * d_.y);
      const Vector<Real> w{d_.x / l, d_.y / l}, v{c.x - b_.p.x, c.y - b_.p.y};
      const Real along = v.x * w.x + v.y * w.y, off = w.x * v.y - w.y * v.x, square = (r - off) * (r + off);
      if (!(square > 0)) return out.resize(first);
      const Real half = kernel::square_root(square);
      return keep((along - half) / l, (along + half) / l, k, first, out);
    }
    const Vector<Real> v{c.x - b_.c.x, c.y - b_.c.y};
    const Real l = kernel::square_root(v.x * v.x + v.y * v.y);
    if (!(l > 0)) return r > radius_ ? void() : out.resize(first);
    // |u R - v| <= r
    cut_by_cap({v.x / l, v.y / l}, (radius_ * radius_ + l * l - r * r) / (2 * radius_ * l), k, first, out);
  }

  const Border<Real>& b_;
  Real radius_;
  Vector<Real> d_, u_{};
  Real end_ = 1;
};

}  // namespace krepl::shape
