#include "verify/solid.hpp"

#include <cmath>
#include <limits>
#include <tuple>

namespace krepl::verify {

namespace {

bool before(Point3 a, Point3 b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

bool exists(const Terrain& terrain, Terrain::Index feature) {
  if (!terrain.is_grid()) return true;
  const std::size_t sample = feature / 6, column = sample % terrain.grid().columns,
                    row = sample / terrain.grid().columns;
  return column + 1 < terrain.grid().columns && row + 1 < terrain.grid().rows;
}

/// One candidate: the part of a triangle that a ball over (x, y) touches, and the height of the ball's centre.
template <class T>
struct Candidate {
  T height = -T(HUGE_VAL);
  int first = 0, count = 0;  // corner, edge (corner and the next one), or face
};

/// Height of the ball's centre when it touches the open segment a b, or -infinity.
template <class T>
T segment_height(Space<T> a, Space<T> b, T x, T y, T radius) {
  const T dx = b.x - a.x, dy = b.y - a.y, dz = b.z - a.z, flat = dx * dx + dy * dy;
  if (!(flat > 0)) return -T(HUGE_VAL);
  const T ex = x - a.x, ey = y - a.y, across = dx * ey - dy * ex;
  const T under = radius * radius - across * across / flat;
  if (!(under >= 0)) return -T(HUGE_VAL);
  // In the vertical plane through the segment the ball is a disk of radius sqrt(under).
  const T lift = root(under / (flat * (flat + dz * dz)));
  const T along = (dx * ex + dy * ey) / flat, touch = along + dz * lift;
  if (!(touch > 0 && touch < 1)) return -T(HUGE_VAL);
  return a.z + along * dz + (flat + dz * dz) * lift;
}

/// Corners in ascending order of their numbers, so that triangles with a common edge agree to the bit about it.
template <class T>
Candidate<T> touch_triangle(const Space<T> (&p)[3], T x, T y, T radius) {
  Candidate<T> best;
  Space<T> n = cross(p[1] - p[0], p[2] - p[0]);
  if (n.z < 0) n = T(-1) * n;
  if (n.z > 0) {
    const T scale = radius / length(n);
    const T tx = x - p[0].x - scale * n.x, ty = y - p[0].y - scale * n.y;  // touched point from corner 0
    const Space<T> u = p[1] - p[0], v = p[2] - p[0];
    const T whole = u.x * v.y - u.y * v.x, s = (tx * v.y - ty * v.x) / whole, t = (u.x * ty - u.y * tx) / whole;
    if (s > 0 && t > 0 && s + t < 1) return {p[0].z + s * u.z + t * v.z + scale * n.z, 0, 3};
  }
  for (int k = 0; k < 3; ++k) {
    const T dx = x - p[k].x, dy = y - p[k].y, under = radius * radius - dx * dx - dy * dy;
    if (under >= 0) {
      const T height = p[k].z + root(under);
      if (height > best.height) best = {height, k, 1};
    }
    const int j = (k + 1) % 3;
    const T height = segment_height(p[std::min(k, j)], p[std::max(k, j)], x, y, radius);
    if (height > best.height) best = {height, k, 2};
  }
  return best;
}

/// How many times rounding may be enlarged in touch_triangle: needles, and balls that touch with their equator.
double conditioning(const Space<double> (&p)[3], double x, double y, double radius) {
  const Space<double> u = p[1] - p[0], v = p[2] - p[0];
  const double sides = length(u) * length(v) + square(v - u), nz = std::abs(u.x * v.y - u.y * v.x);
  double worst = nz > 0 ? sides / nz : 1;
  for (int k = 0; k < 3; ++k) {
    const Space<double> a = p[k], b = p[(k + 1) % 3], d = b - a;
    const double flat = d.x * d.x + d.y * d.y;
    const double dx = x - a.x, dy = y - a.y, rim = radius * radius - dx * dx - dy * dy;
    if (rim > -1e-9 * radius * radius)
      worst = std::max(worst, radius / std::sqrt(std::max(rim, 1e-24 * radius * radius)));
    if (!(flat > 0)) continue;
    const double across = (d.x * dy - d.y * dx), under = radius * radius - across * across / flat;
    if (under > -1e-9 * radius * radius) {
      worst = std::max(worst,
                       radius / std::sqrt(std::max(under, 1e-24 * radius * radius)) * std::sqrt(1 + d.z * d.z / flat));
    }
  }
  return worst;
}

template <class T>
Candidate<long double> touch_in(const Space<double> (&p)[3], double x, double y, double radius) {
  const Space<T> q[3] = {Space<T>(p[0]), Space<T>(p[1]), Space<T>(p[2])};
  const Candidate<T> c = touch_triangle<T>(q, T(x), T(y), T(radius));
  return {(long double)(c.height), c.first, c.count};
}

/// Extended precision, or quadruple where that would lose too much.
Candidate<long double> touch_carefully(const Space<double> (&p)[3], double x, double y, double radius) {
  if (conditioning(p, x, y, radius) < 1e4) return touch_in<long double>(p, x, y, radius);
  return touch_in<Quad>(p, x, y, radius);
}

/// Nearest point of a triangle to the origin of the frame.
template <class T>
Space<T> nearest_on_triangle(Space<T> a, Space<T> b, Space<T> c) {
  const Space<T> n = cross(b - a, c - a), zero(0, 0, 0);
  const T nn = square(n);
  if (nn > 0) {
    const Space<T> p = (dot(a, n) / nn) * n;
    const bool inside =
        dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 && dot(cross(a - c, p - c), n) >= 0;
    if (inside) return p;
  }
  Space<T> best = nearest_on_segment(zero, a, b);
  for (const Space<T> p : {nearest_on_segment(zero, b, c), nearest_on_segment(zero, c, a)})
    if (square(p) < square(best)) best = p;
  return best;
}

/// Square of the distance from the z axis to the part of a triangle with z >= 0.
template <class T>
T square_axis_distance(const Space<T> (&corner)[3]) {
  Space<T> part[4];
  int count = 0;
  for (int k = 0; k < 3; ++k) {
    const Space<T> a = corner[k], b = corner[(k + 1) % 3];
    if (a.z >= 0) part[count++] = a;
    if ((a.z >= 0) != (b.z >= 0)) part[count++] = a + (a.z / (a.z - b.z)) * (b - a);
  }
  T best = T(HUGE_VAL);
  int left = 0, right = 0;
  for (int k = 0; k < count; ++k) {
    const Space<T> a(part[k].x, part[k].y, 0), b(part[(k + 1) % count].x, part[(k + 1) % count].y, 0);
    const T near = square(nearest_on_segment(Space<T>(0, 0, 0), a, b));
    if (near < best) best = near;
    const T side = a.x * b.y - a.y * b.x;
    left += side >= 0, right += side <= 0;
  }
  const bool around = count >= 3 && (left == count) != (right == count);
  return around ? T(0) : best;
}

/// A result's coordinates are rounded when the origin is added, and once more when it is taken off: here the same
/// happens to the terrain's, so that equal points stay equal. Also makes -0 to 0.
Point3 as_in_files(Point3 p, Point3 origin) {
  return {p.x + origin.x - origin.x + 0.0, p.y + origin.y - origin.y + 0.0, p.z + origin.z - origin.z + 0.0};
}

}  // namespace

Solid::Solid(const Terrain& terrain) : origin_(terrain.origin()) {
  std::vector<std::array<Point3, 3>> corners;
  corners.reserve(terrain.triangle_count());
  for (std::size_t f = 0; f < terrain.feature_bound(); ++f) {
    const auto feature = Terrain::Index(f);
    if (terrain.feature_kind(feature) != Terrain::FeatureKind::face || !exists(terrain, feature)) continue;
    auto p = terrain.corners(feature).point;
    bool whole = true;
    for (Point3& q : p) whole = whole && !std::isnan(q.z), q = as_in_files(q, origin_);
    if (whole) corners.push_back(p);
  }
  for (const auto& p : corners) vertices_.insert(vertices_.end(), p.begin(), p.end());
  std::sort(vertices_.begin(), vertices_.end(), before);
  vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
  double largest = 0;
  std::vector<Box3> boxes(corners.size());
  triangles_.reserve(corners.size());
  for (std::size_t t = 0; t < corners.size(); ++t) {
    triangles_.push_back(key_of({corners[t], 3}));
    for (const Point3& q : corners[t]) {
      boxes[t].add(q.x, q.y, q.z);
      for (const double c : {q.x + origin_.x, q.y + origin_.y, q.z + origin_.z})
        largest = std::max(largest, std::abs(c));
    }
  }
  resolution_ = std::nextafter(largest, HUGE_VAL) - largest;
  tree_ = BoxHierarchy(boxes);
}

double Solid::half_extent() const {
  double most = 0;
  for (int k = 0; k < 3; ++k) most = std::max(most, box().high[k] / 2 - box().low[k] / 2);
  return most;
}

FeatureKey Solid::key_of(const Shape& shape) const {
  FeatureKey key{none, none, none};
  for (int k = 0; k < shape.count; ++k) {
    const Point3 p{shape.at[std::size_t(k)].x + 0.0, shape.at[std::size_t(k)].y + 0.0,
                   shape.at[std::size_t(k)].z + 0.0};
    const auto at = std::lower_bound(vertices_.begin(), vertices_.end(), p, before);
    if (at == vertices_.end() || before(p, *at)) return {none, none, none};
    key[std::size_t(k)] = std::uint32_t(at - vertices_.begin());
  }
  std::sort(key.begin(), key.end());
  return key;
}

Shape Solid::shape_of(const FeatureKey& key) const {
  Shape shape;
  for (const std::uint32_t v : key)
    if (v != none) shape.at[std::size_t(shape.count++)] = vertices_[v];
  return shape;
}

void Solid::lower(double x, double y, double radius, double tie, std::vector<Touch>& touches) const {
  touches.clear();
  // In double precision first; 1e-11 R is far more than what that loses at a conditioning of 1e3.
  const double margin = std::max(tie, 1e-11 * std::max(radius, half_extent()));
  double best = -std::numeric_limits<double>::infinity();
  const auto key = [&](const Box3& b) {
    const double under = radius * radius - b.square_distance(x, y);
    return under < -1e-12 * radius * radius ? std::numeric_limits<double>::infinity()
                                            : -(b.high[2] + std::sqrt(std::max(under, 0.0)));
  };
  tree_.search(
      key, [&] { return margin - best; },
      [&](std::uint32_t t) {
        const Space<double> p[3] = {corner(t, 0), corner(t, 1), corner(t, 2)};
        Candidate<double> rough = touch_triangle<double>(p, x, y, radius);
        const bool hard = conditioning(p, x, y, radius) > 1e3;
        if (!hard && !(rough.height >= best - margin)) return;
        const Candidate<long double> c = touch_carefully(p, x, y, radius);
        if (!(c.height > -HUGE_VALL && c.height >= best - margin)) return;
        best = std::max(best, double(c.height));
        const auto& v = triangles_[t];
        const auto first = std::size_t(c.first), next = (first + 1) % 3;
        FeatureKey feature = c.count == 3   ? v
                             : c.count == 1 ? FeatureKey{v[first], none, none}
                                            : FeatureKey{v[first], v[next], none};
        std::sort(feature.begin(), feature.end());
        touches.push_back({feature, c.height});
      });
  std::sort(touches.begin(), touches.end(), [](const Touch& a, const Touch& b) {
    return a.height != b.height ? a.height > b.height : a.feature < b.feature;
  });
  std::erase_if(touches, [&](const Touch& t) { return t.height < touches[0].height - (long double)(tie); });
  // A side or corner of a higher touched feature is only that feature's end.
  for (std::size_t i = touches.size(); i-- > 1;) {
    const auto covers = [&](const Touch& t) {
      if (!(t.height > touches[i].height) && t.feature != touches[i].feature) return false;
      return std::all_of(touches[i].feature.begin(), touches[i].feature.end(), [&](std::uint32_t v) {
        return v == none || std::find(t.feature.begin(), t.feature.end(), v) != t.feature.end();
      });
    };
    if (std::any_of(touches.begin(), touches.begin() + std::ptrdiff_t(i), covers))
      touches.erase(touches.begin() + std::ptrdiff_t(i));
  }
}

template <class T>
double Solid::distance_in(Space<double> c, double limit) const {
  double best = limit * limit;
  const auto key = [&](const Box3& b) {
    const double dz = std::max(0.0, c.z - b.high[2]), square = b.square_distance(c.x, c.y) + dz * dz;
    return square < best ? square : std::numeric_limits<double>::infinity();
  };
  tree_.search(
      key, [&] { return best; },
      [&](std::uint32_t t) {
        const Space<T> from(c),
            p[3] = {Space<T>(corner(t, 0)) - from, Space<T>(corner(t, 1)) - from, Space<T>(corner(t, 2)) - from};
        const Space<T> near = nearest_on_triangle(p[0], p[1], p[2]);
        // Where the nearest point lies higher than c, the nearest of what is solid below the triangle is level with c.
        best = std::min(best, double(near.z > 0 ? square_axis_distance(p) : square(near)));
      });
  return best < limit * limit ? std::sqrt(best) : limit;
}

double Solid::distance(Space<double> c, double limit) const { return distance_in<double>(c, limit); }
double Solid::distance_carefully(Space<double> c, double limit) const { return distance_in<Quad>(c, limit); }

double Solid::plane_distance(double x, double y, double limit) const {
  double best = limit * limit;
  const auto key = [&](const Box3& b) {
    const double square = b.square_distance(x, y);
    return square < best ? square : std::numeric_limits<double>::infinity();
  };
  tree_.search(
      key, [&] { return best; },
      [&](std::uint32_t t) {
        Space<double> p[3];
        for (int k = 0; k < 3; ++k) p[k] = {corner(t, k).x - x, corner(t, k).y - y, 0};
        best = std::min(best, square_axis_distance(p));
      });
  return best < limit * limit ? std::sqrt(best) : limit;
}

}  // namespace krepl::verify
