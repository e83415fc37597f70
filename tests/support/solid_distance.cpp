#include "support/solid_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace krepl::test {

namespace {

using Real = long double;
struct Vector {
  Real x, y, z;
};
Vector from(Point3 p) { return {p.x, p.y, p.z}; }
Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Real dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vector cross(Vector a, Vector b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
Real length(Vector a) { return std::sqrt(dot(a, a)); }

/// To an edge and the wall below it.
Real to_wall(Vector a, Vector b, Vector p) {
  const Vector d = b - a, v = p - a;
  const Real flat = d.x * d.x + d.y * d.y;
  if (flat > 0) {
    const Real s = std::clamp<Real>((v.x * d.x + v.y * d.y) / flat, 0, 1);
    if (p.z <= a.z + s * d.z) return std::hypot(v.x - s * d.x, v.y - s * d.y);
  } else if (p.z <= std::max(a.z, b.z)) {
    return std::hypot(v.x, v.y);
  }
  const Real square = dot(d, d), t = square > 0 ? std::clamp<Real>(dot(v, d) / square, 0, 1) : 0;
  return length({v.x - t * d.x, v.y - t * d.y, v.z - t * d.z});
}

}  // namespace

long double solid_distance(std::span<const std::array<Point3, 3>> triangles, Point3 place) {
  const Vector p = from(place);
  Real nearest = std::numeric_limits<Real>::infinity();
  for (const auto& triangle : triangles) {
    const Vector c[3] = {from(triangle[0]), from(triangle[1]), from(triangle[2])};
    for (int i = 0; i < 3; ++i) nearest = std::min(nearest, to_wall(c[i], c[(i + 1) % 3], p));
    Vector n = cross(c[1] - c[0], c[2] - c[0]);
    if (n.z == 0) continue;
    if (n.z < 0) n = {-n.x, -n.y, -n.z};
    const auto within = [&](Real x, Real y) {
      int left = 0, right = 0;
      for (int i = 0; i < 3; ++i) {
        const Vector a = c[i], b = c[(i + 1) % 3];
        const Real side = (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
        left += side > 0, right += side < 0;
      }
      return left == 0 || right == 0;
    };
    const Real above = dot(p - c[0], n), height = above / length(n);
    if (above <= 0 && within(p.x, p.y)) return 0;
    const Real back = above / dot(n, n);
    if (above > 0 && within(p.x - back * n.x, p.y - back * n.y)) nearest = std::min(nearest, height);
  }
  return nearest;
}

}  // namespace krepl::test
