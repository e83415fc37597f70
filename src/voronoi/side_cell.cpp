#include "voronoi/side_cell.hpp"

namespace krepl::voronoi {

template <class Real>
void SideCell<Real>::start(Index element) {
  element_ = element;
  ends_ = sites_.instance().ends(element);
  const Vector<Real> d = sites_.direction<Real>(element >> 1);
  u_ = (element & 1u) ? Vector<Real>{-d.x, -d.y} : d;
  length_ = zone::length(sites_.template difference<Real>(ends_.to, ends_.from));
  uncertain_ = false;
  Curve horizon;
  horizon.is_line = true;
  horizon.at = {0, Real(sites_.horizon())};
  envelope_.start(0, length_, horizon);
}

template <class Real>
bool SideCell<Real>::add_site(Index site, SiteParts parts) {
  changed_ = false;
  const auto s = sites_.instance().site(site);
  if (s.a == s.b) {
    look_at(locate(s.a));
    add_vertex(s.a, locate(s.a));
  } else if (!is_own(site)) {
    add_segment(site, parts);
  }
  return changed_;
}

/// A point that rounding may have brought to the other side of the base matters where its bisector, at height x^2 / 2y
/// over the base, stays below the horizon.
template <class Real>
void SideCell<Real>::look_at(Vector<Real> q) {
  const Real error = narrow<Real> * (kernel::absolute(q.x) + length_);
  if (!(kernel::absolute(q.y) <= error)) return;
  const Real x = std::max(std::max(-q.x, q.x - length_), Real(0));
  if (x * x <= 2 * error * Real(sites_.horizon())) uncertain_ = true;
}

/// A vertex is nearest only within the sector that its segments leave open. A centre that runs along the parabola with
/// growing x sees its direction from the vertex turn from upwards over left, down and right to upwards again.
template <class Real>
void SideCell<Real>::add_vertex(Index vertex, Vector<Real> q) {
  if (vertex == ends_.from || vertex == ends_.to || !(q.y > 0)) return;
  const auto sector = sites_.instance().sector(vertex);
  if (sector.before == none) return;
  Curve curve;
  curve.label = sites_.instance().circle(vertex);
  curve.at = q;
  if (!sites_.is_side(sector.before)) {
    insert(curve, -infinite<Real>(), infinite<Real>());
    return;
  }
  // The frame is a reflection: counter-clockwise in the plane is clockwise here.
  const Vector<Real> first = rotate(sites_.normal<Real>(sector.after)),
                     last = rotate(sites_.normal<Real>(sector.before));
  // A limit that looks straight up is never reached.
  const auto limit = [&](Vector<Real> n, Real beyond) { return one_minus_y(n) > 0 ? touching(q, n).x : beyond; };
  const Real low = limit(first, -infinite<Real>()), high = limit(last, infinite<Real>());
  if (first.x > 0 && last.x < 0) {  // the sector opens upwards
    insert(curve, -infinite<Real>(), high);
    insert(curve, low, infinite<Real>());
  } else {
    insert(curve, low, high);
  }
}

template <class Real>
void SideCell<Real>::add_line(Curve curve, Vector<Real> normal, Vector<Real> anchor, Vector<Real> place, Real low,
                              Real high) {
  curve.at = place;
  curve.normal = normal;
  curve.anchor = anchor;
  curve.gap = one_minus_y(normal);
  if (!(curve.gap > 0)) return;  // parallel, seen from behind
  curve.slope = normal.x / curve.gap;
  insert(curve, low, high);
}

/// A segment that shares an end with the base: its bisector starts in that end, exactly.
template <class Real>
void SideCell<Real>::add_incident(Curve line, bool at_end, Vector<Real> other, Vector<Real> away, bool reversed) {
  if (!(other.y > 0)) return;
  const Vector<Real> corner{at_end ? length_ : Real(0), Real(0)};
  const Vector<Real> n = at_end ? Vector<Real>{-away.y, away.x} : Vector<Real>{away.y, -away.x};
  if (!(at_end ? n.x < 0 : n.x > 0)) return;
  const Real limit = touching(other, n).x;
  line.label += at_end == reversed ? 1 : 0;
  add_line(line, n, corner, corner, at_end ? limit : Real(0), at_end ? length_ : limit);
}

template <class Real>
void SideCell<Real>::add_segment(Index segment, SiteParts parts) {
  const auto s = sites_.instance().site(segment);
  const Vector<Real> a = locate(s.a), b = locate(s.b);
  if (s.a != ends_.from && s.a != ends_.to) look_at(a);
  if (s.b != ends_.from && s.b != ends_.to) look_at(b);
  if (!(a.y > 0) && !(b.y > 0)) return;
  if (parts & both_sides) add_sides(segment, parts, a, b);
  if ((parts & start_vertex) && sites_.owner(s.a) == segment) add_vertex(s.a, a);
  if ((parts & end_vertex) && sites_.owner(s.b) == segment) add_vertex(s.b, b);
}

template <class Real>
void SideCell<Real>::add_sides(Index segment, SiteParts parts, Vector<Real> a, Vector<Real> b) {
  const auto s = sites_.instance().site(segment);
  Vector<Real> d = rotate(sites_.direction<Real>(segment));
  Curve line;
  line.label = 2 * segment;
  line.is_line = true;
  line.ends[0] = s.a, line.ends[1] = s.b;
  line.places[0] = a, line.places[1] = b;
  if (s.a == ends_.from || s.a == ends_.to) {
    add_incident(line, s.a == ends_.to, b, d, false);
    return;
  }
  if (s.b == ends_.from || s.b == ends_.to) {
    add_incident(line, s.b == ends_.to, a, {-d.x, -d.y}, true);
    return;
  }
  const bool reversed = b.y < a.y;  // the lower end first, so that d points upwards
  const Vector<Real> p = reversed ? b : a, q = reversed ? a : b;
  if (reversed) d = {-d.x, -d.y};
  const bool crosses = !(p.y > 0);  // the base's line
  const Vector<Real> crossing = crosses ? Vector<Real>{p.x - p.y * (q.x - p.x) / (q.y - p.y), Real(0)} : Vector<Real>{};
  // The frame is a reflection: the side on the right of the segment is on the left here.
  if (parts & (reversed ? second_side : first_side)) {
    const Vector<Real> left{-d.y, d.x};
    const Vector<Real> near = crosses ? crossing : touching(p, left);
    Curve left_line = line;
    left_line.label += reversed ? 1 : 0;
    add_line(left_line, left, crosses ? crossing : p, near, touching(q, left).x, near.x);
  }
  if (parts & (reversed ? first_side : second_side)) {
    const Vector<Real> right{d.y, -d.x};
    const Vector<Real> near = crosses ? crossing : touching(p, right);
    Curve right_line = line;
    right_line.label += reversed ? 0 : 1;
    add_line(right_line, right, crosses ? crossing : p, near, near.x, touching(q, right).x);
  }
}

template class SideCell<double>;
template class SideCell<Twofold>;
template class SideCell<quad>;
template class SideCell<wide>;

}  // namespace krepl::voronoi
