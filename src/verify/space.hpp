#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "krepl/point.hpp"

// Plain vector arithmetic in space, in any precision, on purpose apart from the kernel of the engines.
namespace krepl::verify {

/// The verifier's last resort where long double loses too much: needle triangles.
using Quad = __float128;

inline double root(double x) { return std::sqrt(x); }
inline long double root(long double x) { return std::sqrt(x); }
inline Quad root(Quad x) {
  if (!(x > 0)) return 0;
  Quad r = std::sqrt((long double)(x));
  if (r == 0) return 0;
  r = (r + x / r) / 2;
  return (r + x / r) / 2;
}

template <class T>
struct Space {
  T x{}, y{}, z{};
  Space() = default;
  Space(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
  explicit Space(Point3 p) : x(T(p.x)), y(T(p.y)), z(T(p.z)) {}
  template <class U>
  explicit Space(const Space<U>& p) : x(T(p.x)), y(T(p.y)), z(T(p.z)) {}
  friend Space operator+(Space a, Space b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Space operator-(Space a, Space b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Space operator*(T s, Space a) { return {s * a.x, s * a.y, s * a.z}; }
  friend T dot(Space a, Space b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  friend Space cross(Space a, Space b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
  friend T square(Space a) { return dot(a, a); }
  friend T length(Space a) { return root(dot(a, a)); }
};

/// One, two or three points of the input.
struct Shape {
  std::array<Point3, 3> at;
  int count = 0;
};

template <class T>
struct Foot {
  Space<T> at;    ///< nearest point of the whole plane or line, or the point
  T outside = 0;  ///< how far it lies outside the triangle or segment
};

/// Nearest point of the segment a b (b - a may be zero).
template <class T>
Space<T> nearest_on_segment(Space<T> p, Space<T> a, Space<T> b) {
  const Space<T> d = b - a;
  const T t = dot(p - a, d), whole = square(d);
  if (!(t > 0)) return a;
  if (t >= whole) return b;
  return a + (t / whole) * d;
}

/// How far p, a point of the triangle's plane, lies outside the triangle.
template <class T>
T outside_of(Space<T> p, Space<T> a, Space<T> b, Space<T> c, Space<T> normal) {
  const Space<T> corner[3] = {a, b, c};
  bool inside = true;
  T least = T(HUGE_VAL);
  for (int i = 0; i < 3; ++i) {
    const Space<T> s = corner[i], e = corner[(i + 1) % 3];
    if (dot(cross(e - s, p - s), normal) >= 0) continue;
    inside = false;
    const T d = length(p - nearest_on_segment(p, s, e));
    if (d < least) least = d;
  }
  return inside ? T(0) : least;
}

/// Where a ball about c touches the shape, the shape taken without its ends.
template <class T>
Foot<T> foot_on(const Shape& shape, Space<T> c) {
  const Space<T> a(shape.at[0]);
  if (shape.count == 1) return {a, T(0)};
  const Space<T> b(shape.at[1]);
  if (shape.count == 2) {
    const Space<T> d = b - a;
    const T t = dot(c - a, d) / square(d);
    const Space<T> p = a + t * d;
    const T over = t < 0 ? -t : t > 1 ? t - 1 : T(0);
    return {p, over * length(d)};
  }
  const Space<T> corner(shape.at[2]), n = cross(b - a, corner - a);
  const Space<T> p = c - (dot(c - a, n) / square(n)) * n;
  return {p, outside_of(p, a, b, corner, n)};
}

}  // namespace krepl::verify
