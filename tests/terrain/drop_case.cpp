#include "drop_case.hpp"

#include <cmath>
#include <cstdio>

#include "kernel/quad.hpp"

namespace krepl::test {

namespace {

using kernel::quad;

template <class Real>
struct Vector {
  Real x, y, z;
  Vector operator-(const Vector& b) const { return {x - b.x, y - b.y, z - b.z}; }
  Vector operator+(const Vector& b) const { return {x + b.x, y + b.y, z + b.z}; }
  Vector operator*(Real s) const { return {x * s, y * s, z * s}; }
  Real dot(const Vector& b) const { return x * b.x + y * b.y + z * b.z; }
};

template <class Real>
Vector<Real> vector(Point3 p) {
  return {Real(p.x), Real(p.y), Real(p.z)};
}

template <class Real>
Real squared_distance_to_segment(const Vector<Real>& p, const Vector<Real>& a, const Vector<Real>& b) {
  const Vector<Real> d = b - a, e = p - a;
  const Real length = d.dot(d);
  Real s = length > 0 ? d.dot(e) / length : Real(0);
  s = s < 0 ? Real(0) : s > 1 ? Real(1) : s;
  const Vector<Real> off = e - d * s;
  return off.dot(off);
}

/// Squared distance of a point and a triangle: to the plane if the foot is inside, else to the nearest side.
template <class Real>
Real squared_distance(const Vector<Real>& p, const std::array<Vector<Real>, 3>& t) {
  const Vector<Real> u = t[1] - t[0], v = t[2] - t[0], e = p - t[0];
  const Real uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), eu = e.dot(u), ev = e.dot(v);
  const Real determinant = uu * vv - uv * uv;
  if (determinant > 0) {
    const Real a = (vv * eu - uv * ev) / determinant, b = (uu * ev - uv * eu) / determinant;
    if (a >= 0 && b >= 0 && a + b <= 1) {
      const Vector<Real> off = e - u * a - v * b;
      return off.dot(off);
    }
  }
  Real least = squared_distance_to_segment(p, t[0], t[1]);
  for (int i = 1; i < 3; ++i) {
    const Real d = squared_distance_to_segment(p, t[std::size_t(i)], t[std::size_t((i + 1) % 3)]);
    if (d < least) least = d;
  }
  return least;
}

/// A height at which the vertical line through (x, y) is as near to the triangle as anywhere.
template <class Real>
Real nearest_level(Real x, Real y, const std::array<Vector<Real>, 3>& t) {
  const auto cross = [](Real ax, Real ay, Real bx, Real by) { return ax * by - ay * bx; };
  const Real area = cross(t[1].x - t[0].x, t[1].y - t[0].y, t[2].x - t[0].x, t[2].y - t[0].y);
  if (area != 0) {
    const Real v = cross(x - t[0].x, y - t[0].y, t[2].x - t[0].x, t[2].y - t[0].y) / area;
    const Real w = cross(t[1].x - t[0].x, t[1].y - t[0].y, x - t[0].x, y - t[0].y) / area;
    if (v >= 0 && w >= 0 && v + w <= 1) return t[0].z + v * (t[1].z - t[0].z) + w * (t[2].z - t[0].z);
  }
  Real best = -1, level = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector<Real> a = t[i], d = t[(i + 1) % 3] - a;
    const Real length = d.x * d.x + d.y * d.y;
    Real s = length > 0 ? ((x - a.x) * d.x + (y - a.y) * d.y) / length : Real(0);
    s = s < 0 ? Real(0) : s > 1 ? Real(1) : s;
    const Real dx = x - a.x - s * d.x, dy = y - a.y - s * d.y, off = dx * dx + dy * dy;
    if (best < 0 || off < best) best = off, level = a.z + s * d.z;
  }
  return level;
}

template <class Real>
std::optional<Real> height_over(const std::array<Point3, 3>& triangle, Point place, double radius) {
  const std::array<Vector<Real>, 3> t{vector<Real>(triangle[0]), vector<Real>(triangle[1]), vector<Real>(triangle[2])};
  const Real x = place.x, y = place.y, squared = Real(radius) * radius;
  Real low = nearest_level<Real>(x, y, t);
  if (squared_distance<Real>({x, y, low}, t) > squared) return std::nullopt;
  Real high = std::max({triangle[0].z, triangle[1].z, triangle[2].z});
  high += Real(radius) * Real(1.0001);
  for (int step = 0; step < 200; ++step) {
    const Real middle = (low + high) / 2;
    if (middle == low || middle == high) break;
    (squared_distance<Real>({x, y, middle}, t) <= squared ? low : high) = middle;
  }
  return low;
}

double distance(Point3 a, Point3 b) { return double(std::hypot(a.x - b.x, a.y - b.y, a.z - b.z)); }

double distance_to(Point3 p, const Terrain::Corners& c) {
  using Real = long double;
  if (c.count == 1) return distance(p, c.point[0]);
  if (c.count == 2) {
    return double(std::sqrt(
        squared_distance_to_segment<Real>(vector<Real>(p), vector<Real>(c.point[0]), vector<Real>(c.point[1]))));
  }
  return double(std::sqrt(squared_distance<Real>(
      vector<Real>(p), {vector<Real>(c.point[0]), vector<Real>(c.point[1]), vector<Real>(c.point[2])})));
}

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

}  // namespace

std::optional<double> brute_height(const DropCase& c, Point place, double radius, bool exactly) {
  std::optional<double> best;
  for (const auto& t : c.triangles) {
    if (std::max({t[0].x, t[1].x, t[2].x}) < place.x - radius || std::min({t[0].x, t[1].x, t[2].x}) > place.x + radius ||
        std::max({t[0].y, t[1].y, t[2].y}) < place.y - radius || std::min({t[0].y, t[1].y, t[2].y}) > place.y + radius) {
      continue;
    }
    std::optional<double> h;
    if (exactly) {
      if (const auto found = height_over<quad>(t, place, radius)) h = double(*found);
    } else if (const auto found = height_over<long double>(t, place, radius)) {
      h = double(*found);
    }
    if (h && (!best || *h > *best)) best = h;
  }
  return best;
}

std::optional<std::string> fault_of(const DropCase& c, Point place, double radius, const DropCutter::Contact& contact) {
  const double tolerance = 1e-12 * c.scale(radius);
  const auto right = [&](const std::optional<double>& height) {
    return height.has_value() == contact.touches() && (!height || std::abs(*height - contact.height) <= tolerance);
  };
  // Near the rim of the ball extended precision is not enough.
  if (!right(brute_height(c, place, radius, false))) {
    const std::optional<double> height = brute_height(c, place, radius, true);
    if (!right(height)) {
      return "height " + number(contact.height) + " in place of " + (height ? number(*height) : "none") + " at " +
             number(place.x) + ", " + number(place.y) + " with radius " + number(radius);
    }
  }
  if (!contact.touches()) return std::nullopt;
  const Point3 p = contact.point;
  const std::string where = " at " + number(place.x) + ", " + number(place.y) + " with radius " + number(radius);
  const Terrain::Corners corners = c.terrain->corners(contact.feature);
  if (distance_to(p, corners) > tolerance) return "the touched point is not on its feature" + where;
  if (std::abs(distance(p, {place.x, place.y, contact.height}) - radius) > 2 * tolerance)
    return "the touched point is not at distance R" + where;
  const double on = 0x1p-47 * c.scale(radius);
  for (int i = 0; i < corners.count; ++i) {
    if (corners.count == 1) break;
    const Point3 a = corners.point[std::size_t(i)], b = corners.point[std::size_t((i + 1) % corners.count)];
    if (distance(p, a) < on) return "the touched point is a vertex" + where;
    if (corners.count == 3 && distance_to(p, {{a, b}, 2}) < on) return "the touched point is on an edge" + where;
  }
  return std::nullopt;
}

}  // namespace krepl::test
