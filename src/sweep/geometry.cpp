#include "sweep/geometry.hpp"

#include <algorithm>

#include "kernel/pages.hpp"
#include "kernel/parallel.hpp"

// Error bounds are first-order with a factor of two or more to spare.

namespace krepl::sweep {

using kernel::absolute;
using kernel::square_root;
using kernel::unit_roundoff;

Geometry::Geometry(const Instance& instance, const Context& context)
    : in_(instance), coarse_(0x1p-46 * (instance.extent() + instance.radius())) {
  const std::size_t segments = instance.side_count() / 2;
  kernel::resize_pages(context, direction_, segments);
  kernel::resize_pages(context, span_, segments);
  kernel::resize_pages(context, direction_error_, segments);
  Context quiet;
  quiet.threads = context.threads;
  kernel::parallel_blocks(quiet, segments, 1 << 14, [&](std::size_t first, std::size_t last) {
    for (std::size_t s = first; s < last; ++s) {
      const auto ends = in_.site(Index(s));
      Line<double> l;
      const Vector<double> d = difference<double>(ends.b, ends.a);
      set_direction(l, d);
      direction_[s] = l.direction;
      direction_error_[s] = l.direction_error;
      span_[s] = length(d);
    }
  });
}

template <class Real>
void Geometry::set_direction(Line<Real>& l, Vector<Real> d) const {
  const Real span = length(d);
  l.direction = {d.x / span, d.y / span};
  l.direction_error = Real(8 * unit_roundoff<Real>) + 2 * difference_error(d) / span;
}

template <class Real>
Geometry::Line<Real> Geometry::line(Index side) const {
  Line<Real> l;
  const auto ends = in_.ends(side);
  l.base = position<Real>(ends.from);
  if constexpr (std::is_same_v<Real, double>) {
    const Vector<double> u = direction_[side >> 1];
    l.direction = (side & 1u) ? Vector<double>{-u.x, -u.y} : u;
    l.direction_error = direction_error_[side >> 1];
  } else {
    set_direction(l, difference<Real>(ends.to, ends.from));
  }
  l.normal = {l.direction.y, -l.direction.x};
  return l;
}

bool Geometry::may_cross(Index from, Index to) const {
  if (from == to) return false;
  const bool side = is_side(from), other_side = is_side(to);
  if (!side && !other_side) return true;
  // A side touches the circles about its ends, it does not cross them.
  if (!side) return !is_end(to, vertex_of(from));
  if (!other_side) return !is_end(from, vertex_of(to));
  if (from >> 1 == to >> 1) return false;
  // Both touch the circle about a common vertex, so they can meet in a concave corner only.
  const auto e = in_.ends(from), f = in_.ends(to);
  if (e.to == f.from) return true;
  return e.from != f.from && e.from != f.to && e.to != f.to;
}

template <class Real>
Estimate<Real> Geometry::crosses(Index from, Index to) const {
  const Real r = radius<Real>();
  if (!is_side(from) && !is_side(to)) {
    const Vector<Real> d = difference<Real>(vertex_of(to), vertex_of(from));
    return {2 * r - length(d), 2 * difference_error(d) + Real(8 * unit_roundoff<Real>) * r};
  }
  if (is_side(from) && is_side(to)) {
    const auto e = line<Real>(from), f = line<Real>(to);
    return {cross(f.direction, e.direction),
            2 * (e.direction_error + f.direction_error) + Real(8 * unit_roundoff<Real>)};
  }
  const Index side = is_side(from) ? from : to, circle = is_side(from) ? to : from;
  const auto e = line<Real>(side);
  const Vector<Real> w = difference<Real>(vertex_of(circle), in_.ends(side).from);
  const Real k = cross(e.direction, w);  // the centre's distance on the left of the segment
  const Real error = 2 * difference_error(w) + 2 * (absolute(w.x) + absolute(w.y)) * e.direction_error;
  return {std::min<Real>(-k, 2 * r + k), error + Real(8 * unit_roundoff<Real>) * r};
}

template <class Real>
Place<Real> Geometry::touching(Index side, Index circle) const {
  const auto e = line<Real>(side);
  const Real r = radius<Real>();
  return {position<Real>(vertex_of(circle)) + r * e.normal,
          position_error<Real>() + r * (e.direction_error + Real(8 * unit_roundoff<Real>))};
}

template <class Real>
Place<Real> Geometry::side_and_side(Index from, Index to) const {
  const auto e = line<Real>(from), f = line<Real>(to);
  const Real r = radius<Real>();
  const Real turn_error = e.direction_error + f.direction_error + Real(4 * unit_roundoff<Real>);
  const auto ends = in_.ends(from), other = in_.ends(to);
  const Real sine = cross(f.direction, e.direction);
  const Real base_error = position_error<Real>() + r * (e.direction_error + Real(8 * unit_roundoff<Real>));
  if (ends.to == other.from) {  // a concave corner: T = R tan(half the turn)
    const Real cosine = dot(e.direction, f.direction);
    Real t, error;
    if (cosine > 0) {
      t = r * sine / (1 + cosine);
      error = r * turn_error * 4;
    } else {
      t = r * (1 - cosine) / sine;
      error = 4 * t * turn_error / absolute(sine);
    }
    const Vector<Real> start = position<Real>(ends.to) + r * e.normal;
    return {start - t * e.direction, base_error + 2 * error + absolute(t) * 2 * e.direction_error};
  }
  const Vector<Real> w = difference<Real>(other.from, ends.from);
  const Vector<Real> q{w.x + r * (f.normal.x - e.normal.x), w.y + r * (f.normal.y - e.normal.y)};
  const Real size = absolute(w.x) + absolute(w.y) + 2 * r;
  const Real t = -cross(q, f.direction) / sine;
  const Real error = (2 * difference_error(w) + 4 * size * turn_error + 2 * absolute(t) * turn_error) / absolute(sine);
  return {e.base + r * e.normal + t * e.direction, base_error + 2 * error + absolute(t) * 2 * e.direction_error};
}

/// sense -1: the side runs into the disk; +1: it comes out.
template <class Real>
Place<Real> Geometry::side_and_circle(Index side, Index circle, int sense) const {
  const auto e = line<Real>(side);
  const Real r = radius<Real>();
  const Vector<Real> w = difference<Real>(vertex_of(circle), in_.ends(side).from);
  const Real k = cross(e.direction, w), along = dot(e.direction, w);
  const Real w_error = 2 * difference_error(w) + 2 * (absolute(w.x) + absolute(w.y)) * e.direction_error;
  const Real square = std::max<Real>(-k * (2 * r + k), 0);
  const Real square_error = 4 * r * w_error + Real(8 * unit_roundoff<Real>) * square;
  const Real half = square_root(square);
  const Real half_error = square > 4 * square_error ? Real(square_error / half) : Real(3 * square_root(square_error));
  const Real t = along + sense * half;
  return {e.base + r * e.normal + t * e.direction,
          position_error<Real>() + (r + absolute(t)) * (2 * e.direction_error + Real(8 * unit_roundoff<Real>)) +
              w_error + 2 * half_error};
}

template <class Real>
Place<Real> Geometry::circle_and_circle(Index from, Index to) const {
  const Real r = radius<Real>();
  const Vector<Real> d = difference<Real>(vertex_of(to), vertex_of(from));
  const Real span = length(d), relative = difference_error(d) / span + Real(8 * unit_roundoff<Real>);
  const Real c = span / (2 * r);
  const Real square = std::max<Real>((1 - c) * (1 + c), 0);
  const Real square_error = 4 * c * relative + Real(8 * unit_roundoff<Real>);
  const Real s = square_root(square);
  const Real s_error = square > 4 * square_error ? Real(square_error / s) : Real(3 * square_root(square_error));
  const Vector<Real> u{d.x / span, d.y / span};
  return {position<Real>(vertex_of(from)) + r * Vector<Real>{c * u.x + s * u.y, c * u.y - s * u.x},
          position_error<Real>() + r * (4 * relative + 2 * s_error)};
}

template <class Real>
Place<Real> Geometry::place(const Vertex& v) const {
  if (v.is_on_one_circle()) {
    const Real r = radius<Real>();
    const Vector<Real> c = position<Real>(vertex_of(v.from));
    const Real error = position_error<Real>() + Real(8 * unit_roundoff<Real>) * r;
    if (v.to == Vertex::start) return {c + turned(Vector<Real>{Real(in_.radius()), Real(0)}), error};
    return {{v.to == Vertex::leftmost ? Real(c.x - r) : Real(c.x + r), c.y}, error};
  }
  const bool side = is_side(v.from), other_side = is_side(v.to);
  if (side && other_side) return side_and_side<Real>(v.from, v.to);
  if (!side && !other_side) return circle_and_circle<Real>(v.from, v.to);
  if (side) {
    return is_end(v.from, vertex_of(v.to)) ? touching<Real>(v.from, v.to) : side_and_circle<Real>(v.from, v.to, -1);
  }
  return is_end(v.to, vertex_of(v.from)) ? touching<Real>(v.to, v.from) : side_and_circle<Real>(v.to, v.from, +1);
}

template Geometry::Line<double> Geometry::line<double>(Index) const;
template Geometry::Line<quad> Geometry::line<quad>(Index) const;
template Geometry::Line<wide> Geometry::line<wide>(Index) const;
template Estimate<double> Geometry::crosses<double>(Index, Index) const;
template Estimate<quad> Geometry::crosses<quad>(Index, Index) const;
template Estimate<wide> Geometry::crosses<wide>(Index, Index) const;
template Place<double> Geometry::place<double>(const Vertex&) const;
template Place<quad> Geometry::place<quad>(const Vertex&) const;
template Place<wide> Geometry::place<wide>(const Vertex&) const;

}  // namespace krepl::sweep
