#include "zone/crossing.hpp"

#include <algorithm>

namespace krepl::zone {
namespace {

using kernel::absolute;
using kernel::square_root;

// By the smallest relative size among the numbers divided by or rooted: below this, double precision does not serve. Above
// Instance::nominal_condition() the nominal radius serves as well as the enlarged one.
constexpr double ill_conditioned = 0x1p-20;

/// An offset from a vertex, with its condition. `lever` times the vertices' unseen move bounds what the move may change.
template <class Real>
struct Place {
  Index base;
  Vector<Real> offset;
  Real condition;
  Real lever;
};

/// The radius that an element is evaluated with: the enlarged or the nominal one.
template <class Real>
struct Radii {
  Real operator()(Index element) const { return enlarged ? in.radius_of(element) : in.nominal_radius_of(element); }
  const Instance& in;
  bool enlarged;
};

/// A side's frame as in SideElement: u along, y outwards from the offset line.
template <class Real>
struct Frame {
  Frame(const Instance& instance, Index side, Real r) : in(instance), ends(instance.ends(side)), radius(r) {
    const Vector<Real> d = in.difference<Real>(ends.to, ends.from);
    span = length(d);
    u = {d.x / span, d.y / span};
  }
  Vector<Real> rotate(Vector<Real> v) const { return {v.x * u.x + v.y * u.y, v.x * u.y - v.y * u.x}; }
  Vector<Real> locate(Index vertex) const {
    const Vector<Real> v = rotate(in.difference<Real>(vertex, ends.from));
    return {v.x, v.y - radius};
  }
  Place<Real> place(Real at, Real condition) const {
    return {ends.from, {u.x * at + u.y * radius, u.y * at - u.x * radius}, condition, (absolute(at) + radius) / span};
  }
  const Instance& in;
  Instance::Ends ends;
  Real radius;
  Real span;
  Vector<Real> u;
};

/// direction -1: the side runs into the disk; +1: it comes out.
template <class Real>
Place<Real> side_and_circle(const Instance& in, Index side, Index circle, int direction, Radii<Real> r) {
  const Frame<Real> f(in, side, r(side));
  const Index v = in.vertex_of(circle);
  if (v == f.ends.to && direction < 0) return f.place(f.span, 1);
  if (v == f.ends.from && direction > 0) return f.place(0, 1);
  const Vector<Real> q = f.locate(v);
  const Real radius = r(circle);
  const Real square = (radius - q.y) * (radius + q.y);
  return f.place(q.x + direction * square_root(std::max<Real>(square, 0)), square / (radius * radius));
}

template <class Real>
Place<Real> side_and_side(const Instance& in, Index from, Index to, Radii<Real> r) {
  const Frame<Real> f(in, from, r(from));
  const auto other = in.ends(to);
  if (other.from == f.ends.to) {  // neighbours at a concave corner: T = R / tan(half the angle)
    Vector<Real> d = f.rotate(in.difference<Real>(other.to, other.from));
    const Real span = length(d);
    const Real t = d.x > 0 ? f.radius * d.y / (span + d.x) : f.radius * (span - d.x) / d.y;
    auto p = f.place(f.span - t, d.x > 0 ? Real(1) : d.y / span);
    p.lever = std::max(p.lever, f.radius / span);
    return p;
  }
  const Vector<Real> c = f.locate(other.from);
  const Vector<Real> d = f.rotate(in.difference<Real>(other.to, other.from));
  const Real span = length(d);
  const Real radius = r(to);
  const Real t = -(c.y + radius * d.x / span) / d.y;
  auto p = f.place(c.x + t * d.x - radius * d.y / span, absolute(d.y) / span);
  p.lever = std::max(p.lever, (absolute(t) * span + radius) / span);
  return p;
}

template <class Real>
Place<Real> circle_and_circle(const Instance& in, Index from, Index to, Radii<Real> radii) {
  const Index base = in.vertex_of(from);
  const Vector<Real> d = in.difference<Real>(in.vertex_of(to), base);
  const Real span = length(d), r = radii(from), other = radii(to);
  if (r != other) {
    // The cosine of the angle at the base, in a triangle with sides r, `other` and span; 1 -+ it in products.
    const Real c = (span + (r - other) * (r + other) / span) / (2 * r);
    const Real square =
        (other - span + r) * (other + span - r) * (span + r - other) * (span + r + other) / (4 * span * span * r * r);
    const Real s = square_root(std::max<Real>(square, 0));
    const Real sine = s * span / other;  // of the angle between the circles
    const Vector<Real> u{d.x / span, d.y / span};
    return {base, {r * (c * u.x + s * u.y), r * (c * u.y - s * u.x)}, std::min<Real>(square, sine * sine),
            std::max(r, other) / span};
  }
  const Real c = span / (2 * r);
  const Real square = (1 - c) * (1 + c);
  const Real s = square_root(std::max<Real>(square, 0));
  const Vector<Real> u{d.x / span, d.y / span};
  return {base, {r * (c * u.x + s * u.y), r * (c * u.y - s * u.x)}, square, r / span};
}

template <class Real>
Place<Real> place_of(const Instance& in, Index from, Index to, bool enlarged) {
  const Radii<Real> r{in, enlarged};
  if (from == to) return {in.vertex_of(from), {r(from), Real(0)}, 1, 0};  // where a full circle starts
  if (in.is_side(from)) {
    return in.is_side(to) ? side_and_side<Real>(in, from, to, r) : side_and_circle<Real>(in, from, to, -1, r);
  }
  return in.is_side(to) ? side_and_circle<Real>(in, to, from, +1, r) : circle_and_circle<Real>(in, from, to, r);
}

Point add(Point base, Vector<double> offset) { return {base.x + offset.x, base.y + offset.y}; }

}  // namespace

Point crossing(const Instance& in, Index from, Index to) {
  const auto unmoved = [&](const Place<double>& p) { return p.lever * 16 * in.jitter() < in.enlargement(); };
  const auto nominal = place_of<double>(in, from, to, false);
  if (nominal.condition > in.nominal_condition() && unmoved(nominal)) return add(in.vertices()[nominal.base], nominal.offset);
  const auto p = place_of<double>(in, from, to, true);
  if (p.condition > ill_conditioned && unmoved(p)) return add(in.vertices()[p.base], p.offset);
  const auto q = place_of<quad>(in, from, to, true);
  const Vector<quad> base = in.moved(q.base);
  return {double(base.x + q.offset.x), double(base.y + q.offset.y)};
}

bool is_long_arc(const Instance& in, Index before, Index circle, Index after) {
  const auto relative = [&](const Place<quad>& p) {
    const Vector<quad> d = in.difference<quad>(p.base, in.vertex_of(circle));
    return Vector<quad>{d.x + p.offset.x, d.y + p.offset.y};
  };
  const auto p = relative(place_of<quad>(in, before, circle, true)), q = relative(place_of<quad>(in, circle, after, true));
  return p.x * q.y - p.y * q.x <= 0;
}

}  // namespace krepl::zone
