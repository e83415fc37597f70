#include "sweep/predicates.hpp"

#include <algorithm>

namespace krepl::sweep {

using kernel::absolute;
using kernel::unit_roundoff;

/// `value(Real{})` estimates a number in that precision; its sign, or 0 if no precision tells it.
template <class Value>
int Predicates::decide(Value&& value) {
  ++counters.decisions;
  if (const int sign = value(double{}).sign()) return sign;
  ++counters.decided_in_quadruple;
  if (const int sign = value(quad{}).sign()) return sign;
  --counters.decided_in_quadruple;
  ++counters.decided_in_320_bits;
  const int sign = value(wide{}).sign();
  if (sign == 0) ++counters.ties;
  return sign;
}

template <class Real>
Place<Real> Predicates::place_of(const Vertex& v) const {
  if constexpr (std::is_same_v<Real, double>) {
    return {{v.x, v.y}, v.error};
  } else {
    return geometry_.place<Real>(v);
  }
}

Vertex Predicates::placed(Index from, Index to) {
  Vertex v;
  v.from = from;
  v.to = to;
  const auto set = [&](const auto& place) {
    v.x = double(place.at.x);
    v.y = double(place.at.y);
    v.error = double(place.error) + 0x1p-52 * (std::abs(v.x) + std::abs(v.y));
    return v.error <= geometry_.coarse();
  };
  if (!set(geometry_.place<double>(v)) && !set(geometry_.place<quad>(v))) set(geometry_.place<wide>(v));
  return v;
}

Vertex Predicates::vertex(Index from, Index to) {
  Vertex v = placed(from, to);
  if (!geometry_.is_side(from)) v.from_upper = is_on_upper_half(v, from);
  if (!geometry_.is_side(to)) v.to_upper = is_on_upper_half(v, to);
  return v;
}

Vertex Predicates::on_circle(Index circle, Index which) {
  Vertex v;
  v.from = circle;
  v.to = which;
  const auto p = geometry_.place<double>(v);
  v.x = p.at.x, v.y = p.at.y, v.error = p.error;
  return v;
}

bool Predicates::is_on_upper_half(const Vertex& v, Index circle) {
  const int sign = decide([&]<class Real>(Real) -> Estimate<Real> {
    const auto p = place_of<Real>(v);
    const auto c = geometry_.position<Real>(geometry_.vertex_of(circle));
    return {p.at.y - c.y, p.error + geometry_.position_error<Real>()};
  });
  return sign > 0;
}

int Predicates::compare(const Vertex& p, const Vertex& q) {
  if (p.x < q.x - (p.error + q.error)) return -1;
  if (p.x > q.x + (p.error + q.error)) return 1;
  if (p.is_same(q)) return 0;
  const int sign = decide([&]<class Real>(Real) -> Estimate<Real> {
    const auto a = place_of<Real>(p), b = place_of<Real>(q);
    return {a.at.x - b.at.x, a.error + b.error};
  });
  if (sign != 0) return sign;
  return p.from != q.from ? (p.from < q.from ? -1 : 1) : (p.to < q.to ? -1 : 1);
}

/// Positive on the left of the side, where its segment is.
template <class Real>
Estimate<Real> Predicates::above_side(const Vertex& p, const Curve& side) const {
  const auto l = geometry_.line<Real>(side.element);
  const auto place = place_of<Real>(p);
  const Real r = geometry_.radius<Real>();
  const Vector<Real> w = place.at - l.base;
  const Real value = cross(l.direction, w) + r;
  const Real error = 2 * (place.error + geometry_.position_error<Real>()) +
                     2 * (absolute(w.x) + absolute(w.y)) * l.direction_error + Real(8 * unit_roundoff<Real>) * r;
  return {side.rightward ? value : Real(-value), error};
}

/// Of an upper half: positive outside of the circle above its centre, negative inside and below the centre.
template <class Real>
Estimate<Real> Predicates::above_half(const Vertex& p, const Curve& arc) const {
  const auto place = place_of<Real>(p);
  const Real r = geometry_.radius<Real>();
  const Vector<Real> c = geometry_.position<Real>(geometry_.vertex_of(arc.element));
  const Real e = place.error + geometry_.position_error<Real>();
  const Vector<Real> d{place.at.x - c.x, arc.upper ? Real(place.at.y - c.y) : Real(c.y - place.at.y)};
  const Real sign = arc.upper ? Real(1) : Real(-1);
  const Real value = d.x * d.x + d.y * d.y - r * r;
  const Real error = (2 * (absolute(d.x) + absolute(d.y)) + e) * e * 2 + Real(16 * unit_roundoff<Real>) * r * r;
  if (value < -error || d.y < -e) return {-sign, 0};
  if (value > error && d.y > e) return {sign, 0};
  return {Real(0), Real(1)};
}

int Predicates::locate(const Vertex& p, const Curve& curve) {
  const auto touches = [&](Index element, bool upper) -> int {
    if (element == curve.element) return geometry_.is_side(element) || upper == curve.upper ? 0 : (upper ? 1 : -1);
    return 2;
  };
  if (const int at = touches(p.from, p.from_upper); at != 2) return at;
  if (!p.is_on_one_circle()) {
    if (const int at = touches(p.to, p.to_upper); at != 2) return at;
  }
  if (!geometry_.is_side(curve.element)) {
    return decide([&]<class Real>(Real) { return above_half<Real>(p, curve); });
  }
  // A circle about an end of a side's segment is on the segment's side of it.
  const auto ends = geometry_.instance().ends(curve.element);
  const auto is_about_end = [&](Index element) {
    if (element >= Vertex::start || geometry_.is_side(element)) return false;
    const Index v = geometry_.vertex_of(element);
    return v == ends.from || v == ends.to;
  };
  if (is_about_end(p.from) || is_about_end(p.to)) return curve.rightward ? 1 : -1;
  return decide([&]<class Real>(Real) { return above_side<Real>(p, curve); });
}

bool Predicates::runs_rightward(Index side) {
  const int sign = decide([&]<class Real>(Real) -> Estimate<Real> {
    const auto l = geometry_.line<Real>(side);
    return {l.direction.x, l.direction_error};
  });
  return sign > 0;
}

bool Predicates::crosses(Index from, Index to) {
  if (!geometry_.may_cross(from, to)) return false;
  return decide([&]<class Real>(Real) { return geometry_.crosses<Real>(from, to); }) > 0;
}

}  // namespace krepl::sweep
