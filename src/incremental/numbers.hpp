#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "krepl/point.hpp"

namespace krepl::incremental {

using Index = std::uint32_t;
inline constexpr Index none = ~Index{0};

/// Small inputs, so digits are cheap: 64 bits of mantissa where the machine has them.
using Real = long double;
inline constexpr Real below_everything = -std::numeric_limits<Real>::infinity();

struct Vector {
  Real x = 0, y = 0, z = 0;
  Vector() = default;
  Vector(Real x0, Real y0, Real z0) : x(x0), y(y0), z(z0) {}
  explicit Vector(Point3 p) : x(p.x), y(p.y), z(p.z) {}
  explicit operator Point3() const { return {double(x), double(y), double(z)}; }
  Vector operator-() const { return {-x, -y, -z}; }
  friend Vector operator+(Vector v, Vector w) { return {v.x + w.x, v.y + w.y, v.z + w.z}; }
  friend Vector operator-(Vector v, Vector w) { return {v.x - w.x, v.y - w.y, v.z - w.z}; }
  friend Vector operator*(Real s, Vector v) { return {s * v.x, s * v.y, s * v.z}; }
};
inline Real dot(Vector v, Vector w) { return v.x * w.x + v.y * w.y + v.z * w.z; }
inline Vector cross(Vector v, Vector w) {
  return {v.y * w.z - v.z * w.y, v.z * w.x - v.x * w.z, v.x * w.y - v.y * w.x};
}
inline Real length(Vector v) { return std::sqrt(dot(v, v)); }
inline Vector unit(Vector v) { return (1 / length(v)) * v; }
/// Distance seen from above.
inline Real flat_distance(Vector v, Vector w) {
  const Real x = v.x - w.x, y = v.y - w.y;
  return std::sqrt(x * x + y * y);
}

/// Rectangle of the plane.
struct Box {
  Real low_x = std::numeric_limits<Real>::infinity(), low_y = low_x, high_x = -low_x, high_y = -low_x;
  void add(Vector p) {
    low_x = std::fmin(low_x, p.x), high_x = std::fmax(high_x, p.x);
    low_y = std::fmin(low_y, p.y), high_y = std::fmax(high_y, p.y);
  }
  Box grown(Real by) const {
    Box b = *this;
    b.low_x -= by, b.low_y -= by, b.high_x += by, b.high_y += by;
    return b;
  }
  bool meets(const Box& b) const {
    return low_x <= b.high_x && b.low_x <= high_x && low_y <= b.high_y && b.low_y <= high_y;
  }
  bool contains(Vector p) const { return p.x >= low_x && p.x <= high_x && p.y >= low_y && p.y <= high_y; }
};

/// Lengths that decide what is the same, all in proportion to S, the largest of R and the input's extent.
struct Tolerance {
  Real scale;   ///< S
  Real touch;   ///< what is deeper inside the sum than that is hidden
  Real weld;    ///< vertices of the map nearer to each other than that are one
  Real finest;  ///< stretches of curves are not cut shorter
  Real tie;     ///< heights nearer than that are equal

  explicit Tolerance(Real scale_of_all)
      : scale(scale_of_all),
        touch(0x1p-50L * scale),
        weld(0x1p-46L * scale),
        finest(0x1p-54L * scale),
        tie(0x1p-58L * scale) {}
};

}  // namespace krepl::incremental
