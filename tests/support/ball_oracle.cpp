#include "support/ball_oracle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace krepl::test {

namespace {

constexpr Long below_all = -std::numeric_limits<Long>::infinity();

LongPoint minus(LongPoint p, LongPoint q) { return {p.x - q.x, p.y - q.y, p.z - q.z}; }
LongPoint lengthen(Point3 p) { return {p.x, p.y, p.z}; }
LongPoint along(LongPoint p, Long s, LongPoint d) { return {p.x + s * d.x, p.y + s * d.y, p.z + s * d.z}; }
Long dot(LongPoint v, LongPoint w) { return v.x * w.x + v.y * w.y + v.z * w.z; }
LongPoint cross(LongPoint v, LongPoint w) {
  return {v.y * w.z - v.z * w.y, v.z * w.x - v.x * w.z, v.x * w.y - v.y * w.x};
}
Long length(LongPoint v) { return std::sqrt(dot(v, v)); }

Nearest nearest_on_segment(LongPoint a, LongPoint b, LongPoint p) {
  const LongPoint d = minus(b, a);
  const Long dd = dot(d, d), s = dd > 0 ? std::clamp(dot(minus(p, a), d) / dd, Long(0), Long(1)) : 0;
  const LongPoint at = along(a, s, d);
  return {at, length(minus(p, at))};
}

Long sphere_height(LongPoint v, Point p, Long radius) {
  const Long dx = p.x - v.x, dy = p.y - v.y, under = radius * radius - dx * dx - dy * dy;
  return under >= 0 ? v.z + std::sqrt(under) : below_all;
}

/// The contact of the highest ball lies at this share of the edge: the top of a cylinder in the plane of the place that
/// is parallel to the axis is the axis' direction moved along by m / sqrt(1 + m^2) of the height above it.
Long cylinder_height(LongPoint a, LongPoint b, Point p, Long radius) {
  const LongPoint d = minus(b, a);
  const Long flat = std::hypot(d.x, d.y);
  if (flat == 0) return below_all;
  const Long gx = d.x / flat, gy = d.y / flat, m = d.z / flat;
  const Long forth = (p.x - a.x) * gx + (p.y - a.y) * gy, aside = (p.y - a.y) * gx - (p.x - a.x) * gy;
  const Long under = radius * radius - aside * aside;
  if (under < 0) return below_all;
  const Long q = std::sqrt(1 + m * m), contact = forth + m / q * std::sqrt(under);
  if (contact < 0 || contact > flat) return below_all;
  return a.z + m * forth + q * std::sqrt(under);
}

Long plane_height(LongPoint a, LongPoint b, LongPoint c, Point p, Long radius) {
  const LongPoint u = minus(b, a), v = minus(c, a);
  LongPoint n = cross(u, v);
  const Long area = n.z, size = length(n) * (n.z < 0 ? -1 : 1);
  if (area == 0) return below_all;
  n = {n.x / size, n.y / size, n.z / size};
  const Long x = p.x - radius * n.x - a.x, y = p.y - radius * n.y - a.y;  // the contact, from a
  const Long s = (x * v.y - y * v.x) / area, t = (u.x * y - u.y * x) / area;
  if (s < 0 || t < 0 || s + t > 1) return below_all;
  return a.z + s * u.z + t * v.z + radius * n.z;
}

}  // namespace

Nearest nearest_on(const Terrain::Corners& feature, LongPoint p) {
  const LongPoint a = lengthen(feature.point[0]);
  if (feature.count == 1) return {a, length(minus(p, a))};
  const LongPoint b = lengthen(feature.point[1]);
  if (feature.count == 2) return nearest_on_segment(a, b, p);
  const LongPoint c = lengthen(feature.point[2]);
  const LongPoint u = minus(b, a), v = minus(c, a), w = minus(p, a), n = cross(u, v);
  const Long nn = dot(n, n);
  if (nn > 0) {
    const Long s = dot(cross(w, v), n) / nn, t = dot(cross(u, w), n) / nn;
    if (s >= 0 && t >= 0 && s + t <= 1) return {along(along(a, s, u), t, v), std::fabs(dot(w, n)) / std::sqrt(nn)};
  }
  Nearest best = nearest_on_segment(a, b, p);
  for (const Nearest& other : {nearest_on_segment(b, c, p), nearest_on_segment(c, a, p)}) {
    if (other.distance < best.distance) best = other;
  }
  return best;
}

BallOracle::BallOracle(std::span<const SmallTerrain::Triangle> triangles, Point3 origin, double radius)
    : radius_(radius) {
  const auto relative = [&](Point3 p) { return Point3{p.x - origin.x, p.y - origin.y, p.z - origin.z}; };
  for (const auto& t : triangles) {
    const Terrain::Corners face{{relative(t[0]), relative(t[1]), relative(t[2])}, 3};
    // Triangles without area do not count at all (Terrain::Report).
    const LongPoint n = cross(minus(lengthen(face.point[1]), lengthen(face.point[0])),
                              minus(lengthen(face.point[2]), lengthen(face.point[0])));
    if (n.x == 0 && n.y == 0 && n.z == 0) continue;
    triangles_.push_back(face);
    features_.push_back(face);
    for (std::size_t k = 0; k < 3; ++k) {
      features_.push_back({{face.point[k], face.point[(k + 1) % 3], {}}, 2});
      features_.push_back({{face.point[k], {}, {}}, 1});
    }
  }
}

Long BallOracle::height(const Terrain::Corners& feature, Point p) const {
  const LongPoint a = lengthen(feature.point[0]), b = lengthen(feature.point[1]), c = lengthen(feature.point[2]);
  switch (feature.count) {
    case 1:
      return sphere_height(a, p, radius_);
    case 2:
      return cylinder_height(a, b, p, radius_);
    default:
      return plane_height(a, b, c, p, radius_);
  }
}

/// In the plane, from the rectangle around the corners.
Long BallOracle::beside(const Terrain::Corners& f, Long x, Long y) {
  double low_x = f.point[0].x, high_x = low_x, low_y = f.point[0].y, high_y = low_y;
  for (int k = 1; k < f.count; ++k) {
    const Point3 p = f.point[std::size_t(k)];
    low_x = std::min(low_x, p.x), high_x = std::max(high_x, p.x);
    low_y = std::min(low_y, p.y), high_y = std::max(high_y, p.y);
  }
  return std::max({low_x - x, x - high_x, low_y - y, y - high_y, Long(0)});
}

Long BallOracle::height(Point p) const {
  Long best = below_all;
  for (const auto& f : features_) {
    if (beside(f, p.x, p.y) <= radius_) best = std::max(best, height(f, p));
  }
  return best;
}

Long BallOracle::distance(LongPoint p) const {
  Long least = std::numeric_limits<Long>::infinity();
  for (const auto& t : triangles_) {
    if (beside(t, p.x, p.y) < least) least = std::min(least, nearest_on(t, p).distance);
  }
  return least;
}

}  // namespace krepl::test
