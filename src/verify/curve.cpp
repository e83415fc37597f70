#include <algorithm>

#include "verify/boundary.hpp"

namespace krepl::verify {

namespace {

Vec turned(Vec v, Real angle) {
  const Real c = std::cos(angle), s = std::sin(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}

}  // namespace

Vec Curve::at(Real t) const {
  if (bow) return bow->at(t);
  if (!arc) return a + t * (b - a);
  return c + turned(a - c, t * sweep);
}

Vec Curve::normal(Real t) const {
  if (bow) return bow->normal(t);
  if (!arc) {
    const Vec d = b - a;
    const Real l = verify::length(d);
    return l > 0 ? Vec(d.y / l, -d.x / l) : Vec();
  }
  const Vec u = turned(a - c, t * sweep);
  return ((sweep > 0 ? 1 : -1) / verify::length(u)) * u;
}

Real Curve::length() const { return arc ? std::abs(sweep) * r : verify::distance(a, b); }

bool Curve::sweeps(Vec d) const {
  if (a.x == b.x && a.y == b.y) return true;
  const Vec u = sweep > 0 ? a - c : b - c, v = sweep > 0 ? b - c : a - c;
  // Counter-clockwise from u to v.
  if (std::abs(sweep) <= 3.141592653589793238L) return cross(u, d) > 0 && cross(d, v) > 0;
  return !(cross(v, d) >= 0 && cross(d, u) >= 0);
}

Real Curve::distance(Vec p) const {
  if (bow) return bow->distance(p);
  if (!arc) return distance_to_segment(p, a, b);
  const Vec d = p - c;
  if (sweeps(d)) return std::abs(verify::length(d) - r);
  return std::min(verify::distance(p, a), verify::distance(p, b));
}

Box Curve::box() const {
  if (bow) return bow->box();
  Box result;
  result.add(a), result.add(b);
  if (arc)
    for (const Vec d : {Vec(r, 0), Vec(0, r), Vec(-r, 0), Vec(0, -r)})
      if (sweeps(d)) result.add(c + d);
  return result;
}

}  // namespace krepl::verify
