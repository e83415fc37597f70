#pragma once

#include <cstdint>

#include "kernel/quad.hpp"
#include "krepl/point.hpp"

/// Distances from a place to what is solid: segments of the plane (z = 0), and in space triangles with everything below
/// them. All of these are convex. In double or in quadruple precision; coordinates relative to the place, which is
/// zero.
namespace krepl::free {

template <class Real>
struct Vector {
  Real x = 0, y = 0, z = 0;

  Vector() = default;
  Vector(Real x_, Real y_, Real z_) : x(x_), y(y_), z(z_) {}
  /// p seen from a place.
  Vector(Point3 p, Point3 place) : x(Real(p.x) - place.x), y(Real(p.y) - place.y), z(Real(p.z) - place.z) {}

  friend Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vector operator*(Real s, Vector a) { return {s * a.x, s * a.y, s * a.z}; }
};
template <class Real>
Real dot(Vector<Real> a, Vector<Real> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Real>
Vector<Real> cross(Vector<Real> a, Vector<Real> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Where an obstacle is nearest. `part`: corner 0 .. 2, edge 3 .. 5 (3 + k from corner k to the next), or the face, 6.
template <class Real>
struct Nearest {
  Vector<Real> at;
  Real square;
  std::uint8_t part;

  Nearest(Vector<Real> at_, int part_) : at(at_), square(dot(at_, at_)), part(std::uint8_t(part_)) {}
  Real distance() const {
    // Quadruple roots start from double ones, which end at 1e308; places may be as far as that themselves.
    if (!(square > Real(1e300))) return kernel::square_root(square);
    return Real(0x1p600) * kernel::square_root(square * Real(0x1p-600) * Real(0x1p-600));
  }
};
inline constexpr int edge_part = 3, face_part = 6;

/// To a segment between corners 0 and 1.
template <class Real>
Nearest<Real> nearest_of_segment(Vector<Real> a, Vector<Real> b) {
  const Vector<Real> d = b - a;
  const Real along = -dot(a, d), whole = dot(d, d);
  if (!(along > 0)) return {a, 0};
  if (!(along < whole)) return {b, 1};
  return {a + (along / whole) * d, edge_part};
}

/// To a segment and everything below it.
template <class Real>
Nearest<Real> nearest_of_wall(Vector<Real> a, Vector<Real> b) {
  const Vector<Real> d = b - a;
  const Real flat = d.x * d.x + d.y * d.y, along = -(a.x * d.x + a.y * d.y);
  if (!(flat > 0)) {  // vertical
    const bool up = a.z < b.z;
    if (!((up ? b.z : a.z) >= 0)) return nearest_of_segment(a, b);
    const bool beside = (up ? a.z : b.z) < 0 && (up ? b.z : a.z) > 0;
    return {{a.x, a.y, 0}, beside ? edge_part : up ? 1 : 0};
  }
  const bool before = !(along > 0), behind = !(along < flat);
  const Vector<Real> over = before ? a : behind ? b : a + (along / flat) * d;
  if (!(over.z >= 0)) return nearest_of_segment(a, b);
  return {{over.x, over.y, 0}, before ? 0 : behind ? 1 : edge_part};
}

/// To a triangle and everything below it. Where the place is below the triangle: at distance 0. A vertical triangle has
/// no face.
template <class Real>
Nearest<Real> nearest_of_shadow(const Vector<Real> (&p)[3], bool vertical) {
  Vector<Real> n = cross(p[1] - p[0], p[2] - p[0]);
  const bool clockwise = n.z < 0;
  if (clockwise) n = Real(-1) * n;
  if (n.z > 0 && !vertical) {
    const Real above = -dot(p[0], n);
    const Vector<Real> axis = above > 0 ? n : Vector<Real>(0, 0, 1);
    bool within = true;
    for (int k = 0; k < 3 && within; ++k) {
      const Real side = -dot(cross(axis, p[(k + 1) % 3] - p[k]), p[k]);
      within = clockwise ? !(side > 0) : !(side < 0);
    }
    if (within) return {above > 0 ? (-above / dot(n, n)) * n : Vector<Real>(), face_part};
  }
  Nearest<Real> best = nearest_of_wall(p[0], p[1]);
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    Nearest<Real> wall = k == 0 ? best : nearest_of_wall(p[k], p[next]);
    wall.part = std::uint8_t(wall.part == edge_part ? edge_part + k : wall.part == 0 ? k : next);
    if (k == 0 || wall.square < best.square) best = wall;
  }
  return best;
}

/// True where double precision would lose too many digits of a triangle's normal: angles below 3.6 degrees.
inline bool is_sliver(const Vector<double> (&p)[3]) {
  const Vector<double> u = p[1] - p[0], v = p[2] - p[0], n = cross(u, v);
  return !(dot(n, n) > 0x1p-8 * dot(u, u) * dot(v, v));
}

}  // namespace krepl::free
