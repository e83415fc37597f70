#include "terrain/curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace krepl::terrain {

using FeatureKind = Terrain::FeatureKind;
using Curve = Surface::Curve;

namespace {

/// Directions that differ by less count as parallel or coplanar.
constexpr double parallel = 1e-12;

template <class Real>
struct Vector {
  Real x, y, z;
  Vector() = default;
  Vector(Real x0, Real y0, Real z0) : x(x0), y(y0), z(z0) {}
  explicit Vector(Point3 p) : x(p.x), y(p.y), z(p.z) {}
  explicit operator Point3() const { return {double(x), double(y), double(z)}; }
  friend Vector operator-(Vector v, Vector w) { return {v.x - w.x, v.y - w.y, v.z - w.z}; }
  friend Vector operator+(Vector v, Vector w) { return {v.x + w.x, v.y + w.y, v.z + w.z}; }
  friend Vector operator*(Real s, Vector v) { return {s * v.x, s * v.y, s * v.z}; }
  friend Real dot(Vector v, Vector w) { return v.x * w.x + v.y * w.y + v.z * w.z; }
  friend Vector cross(Vector v, Vector w) { return {v.y * w.z - v.z * w.y, v.z * w.x - v.x * w.z, v.x * w.y - v.y * w.x}; }
  friend Real length(Vector v) { return std::sqrt(dot(v, v)); }
  friend Vector unit(Vector v) { return (1 / length(v)) * v; }
};
using Vector3 = Vector<double>;
Vector3 operator-(Point3 p, Point3 q) { return Vector3(p) - Vector3(q); }
Point3 operator+(Point3 p, Vector3 v) { return Point3(Vector3(p) + v); }

template <class Real>
struct Contact {
  FeatureKind kind;
  Vector<Real> at;
  Vector<Real> direction;  // edge: along it; face: its upward normal
  Real length;             // of an edge
};

template <class Real = double>
Contact<Real> contact_of(const Terrain& terrain, Surface::Index feature) {
  const auto c = terrain.corners(feature);
  const Vector<Real> a(c.point[0]);
  if (c.count == 1) return {FeatureKind::vertex, a, {0, 0, 0}, 0};
  if (c.count == 2) {
    const Vector<Real> d = Vector<Real>(c.point[1]) - a;
    return {FeatureKind::edge, a, unit(d), length(d)};
  }
  Vector<Real> n = unit(cross(Vector<Real>(c.point[1]) - a, Vector<Real>(c.point[2]) - a));
  if (n.z < 0) n = Real(-1) * n;
  return {FeatureKind::face, a, n, 0};
}

/// Signed distance of a point from what the ball touches, less R, and its gradient.
template <class Real>
struct Offset {
  Real value;
  Vector<Real> gradient;
};
template <class Real>
Offset<Real> offset(const Contact<Real>& c, double radius, Vector<Real> p) {
  const Vector<Real> d = p - c.at;
  if (c.kind == FeatureKind::face) return {dot(d, c.direction) - radius, c.direction};
  const Vector<Real> away = c.kind == FeatureKind::vertex ? d : d + (-dot(d, c.direction)) * c.direction;
  const Real l = length(away);
  return {l - radius, l > 0 ? (1 / l) * away : Vector<Real>{0, 0, 1}};
}

/// Of what the ball touches, straight above or below a place; how fast that changes at most.
struct Height {
  double z, slope;
};
Height height(const Contact<double>& c, double radius, Point3 p) {
  const Vector3 v = Vector3(p) - c.at;
  if (c.kind == FeatureKind::face) {
    return {c.at.z + (radius - c.direction.x * v.x - c.direction.y * v.y) / c.direction.z,
            std::hypot(c.direction.x, c.direction.y) / c.direction.z};
  }
  if (c.kind == FeatureKind::vertex) {
    const double up = std::sqrt(std::max(0.0, radius * radius - v.x * v.x - v.y * v.y));
    return {c.at.z + up, radius / up};
  }
  const double flat = std::hypot(c.direction.x, c.direction.y), m = c.direction.z / flat;
  const double along = (v.x * c.direction.x + v.y * c.direction.y) / flat;
  const double aside = (v.y * c.direction.x - v.x * c.direction.y) / flat;
  const double up = std::sqrt(std::max(0.0, radius * radius - aside * aside));
  return {c.at.z + m * along + up / flat, radius / up / flat};
}

/// Newton's method towards the curve where both distances are R, by the shortest way: along the mean of the two
/// normals, and along their difference as far as rounding lets that be told and no farther than `reach`. Where the
/// surfaces all but touch along a stretch, the curve is known across it no better than that. Between two walls the mean of
/// the normals is nothing: where that leads nowhere the way begins on the higher surface. `sine`, if wanted: of the angle between the two
/// surfaces there.
template <class Real>
Point3 project_to_valley(const Terrain& terrain, double radius, const Surface::Edge& edge, Point3 near, double reach,
                         double* sine = nullptr) {
  const auto a = contact_of<Real>(terrain, edge.feature[0]), b = contact_of<Real>(terrain, edge.feature[1]);
  const Real precision = 2 * std::numeric_limits<Real>::epsilon();
  const auto solve = [&](bool aside, Point3 start) {
    Vector<Real> p(start);
    for (int i = 0; i < 20; ++i) {
      const Offset<Real> f = offset(a, radius, p), g = offset(b, radius, p);
      const Vector<Real> mean = f.gradient + g.gradient, apart = f.gradient - g.gradient;
      const Real square = dot(apart, apart), difference = f.value - g.value;
      if (sine != nullptr) *sine = double(std::sqrt(square * dot(mean, mean)) / 2);
      const Real size = std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z);
      Vector<Real> step = -(f.value + g.value) / dot(mean, mean) * mean;
      if (aside && std::fabs(difference) > 8 * precision * (size + Real(radius)))
        step = step + (-difference / square) * apart;
      p = p + step;
      if (!(length(step) > precision * size)) break;
    }
    return p;
  };
  const auto is_near = [&](Vector<Real> p) { return length(p - Vector<Real>(near)) < reach; };
  Vector<Real> p = solve(true, near);
  if (!is_near(p)) p = solve(false, near);
  if (!is_near(p)) {
    Point3 above = near;
    for (const Surface::Index f : edge.feature) above.z = std::max(above.z, height(contact_of(terrain, f), radius, near).z);
    p = solve(true, above);
  }
  return is_near(p) ? Point3(p) : near;
}

/// The circle along which an edge's cylinder meets the sphere about one of its ends, or another cylinder in line with it: at
/// the end of either that is nearest.
Point3 on_end_circle(const Terrain& terrain, double radius, const Surface::Edge& edge, Point3 near) {
  const auto a = terrain.corners(edge.feature[0]), b = terrain.corners(edge.feature[1]);
  const auto& line = a.count == 2 ? a : b;
  const auto& other = a.count == 2 ? b : a;
  const Vector3 d = unit(line.point[1] - line.point[0]);
  Point3 center = other.point[0];
  if (other.count == 2) {
    const std::array<Point3, 4> ends{line.point[0], line.point[1], other.point[0], other.point[1]};
    const auto along = [&](Point3 end) { return std::fabs(dot(near - end, d)); };
    center = *std::min_element(ends.begin(), ends.end(), [&](Point3 p, Point3 q) { return along(p) < along(q); });
  }
  const Vector3 v = near - center;
  return center + radius * unit(v + (-dot(v, d)) * d);
}

Point3 on_rim(const Contact<double>& c, double radius, Point3 near) {
  const Point3 at(c.at);
  Vector3 v = near - at;
  if (c.kind == FeatureKind::face) {  // nearly vertical: the cylinder beside it is too thin to show
    return {near.x, near.y, at.z + (radius - c.direction.x * v.x - c.direction.y * v.y) / c.direction.z};
  }
  if (c.kind == FeatureKind::vertex) {
    v.z = 0;
    return at + radius * unit(v);
  }
  const Vector3 aside = unit(Vector3{-c.direction.y, c.direction.x, 0});
  const double sign = dot(v, aside) < 0 ? -1 : 1;
  const double flat = std::hypot(c.direction.x, c.direction.y);
  const double along = (v.x * c.direction.x + v.y * c.direction.y) / (flat * flat);
  Point3 p = at + (along * c.direction + (sign * radius) * aside);
  // A wall may begin a bit beyond the edge's end: level there, or in line with it, as the surface has it.
  const double level = at.z + std::clamp(along, 0.0, c.length) * c.direction.z, in_line = at.z + along * c.direction.z;
  p.z = std::fabs(near.z - in_line) < std::fabs(near.z - level) ? in_line : level;
  return p;
}

}  // namespace

bool are_in_one_line(const Terrain& terrain, Surface::Index f, Surface::Index g) {
  const auto is_edge = [&](Surface::Index i) {
    return i != Surface::none && terrain.feature_kind(i) == FeatureKind::edge;
  };
  if (!is_edge(f) || !is_edge(g)) return false;
  const Contact<double> a = contact_of(terrain, f), b = contact_of(terrain, g);
  return length(cross(a.direction, b.direction)) <= parallel &&
         length(cross(b.at - a.at, a.direction)) <= parallel * terrain.extent();
}

Curve curve_kind(const Terrain& terrain, const Surface::Edge& edge) {
  if (edge.feature[0] == Surface::none || edge.feature[1] == Surface::none) {
    const Surface::Index upper = edge.feature[0] == Surface::none ? edge.feature[1] : edge.feature[0];
    return upper != Surface::none && terrain.feature_kind(upper) == FeatureKind::vertex ? Curve::circle : Curve::line;
  }
  Contact<double> a = contact_of(terrain, edge.feature[0]), b = contact_of(terrain, edge.feature[1]);
  if (a.kind < b.kind) std::swap(a, b);  // face, edge, vertex
  if (edge.kind == Surface::EdgeKind::seam) return a.kind == FeatureKind::face ? Curve::line : Curve::circle;
  if (a.kind == FeatureKind::face) {
    if (b.kind == FeatureKind::face) return Curve::line;
    if (b.kind == FeatureKind::vertex) return Curve::circle;
    return std::fabs(dot(a.direction, b.direction)) <= parallel ? Curve::line : Curve::ellipse;
  }
  if (a.kind == FeatureKind::vertex) return Curve::circle;
  if (b.kind == FeatureKind::vertex) return Curve::quartic;
  const Vector3 normal = cross(a.direction, b.direction);
  const double sine = length(normal);
  if (sine <= parallel) return Curve::line;
  const Vector3 between = b.at - a.at;
  const bool meet = std::fabs(dot(between, normal)) <= parallel * sine * (length(between) + terrain.extent());
  return meet ? Curve::ellipse : Curve::quartic;
}

Point3 project_to_curve(const Terrain& terrain, double radius, const Surface::Edge& edge, Point3 near, double reach) {
  if (edge.feature[0] == Surface::none || edge.feature[1] == Surface::none) {
    const Surface::Index upper = edge.feature[0] == Surface::none ? edge.feature[1] : edge.feature[0];
    return upper == Surface::none ? near : on_rim(contact_of(terrain, upper), radius, near);
  }
  if (edge.kind == Surface::EdgeKind::seam && edge.curve == Curve::circle) return on_end_circle(terrain, radius, edge, near);
  if (edge.kind == Surface::EdgeKind::seam) return near;  // a straight line between its ends
  double sine = 1;
  const Point3 p = project_to_valley<double>(terrain, radius, edge, near, reach, &sine);
  // Where the surfaces are nearly tangent their distances have to be known better than doubles tell.
  constexpr double nearly_tangent = 1e-4;
  return sine < nearly_tangent ? project_to_valley<long double>(terrain, radius, edge, near, reach) : p;
}

bool is_on_edge(const Terrain& terrain, double radius, const Surface::Edge& edge, Point3 p, double tolerance) {
  return std::all_of(edge.feature.begin(), edge.feature.end(), [&](Surface::Index f) {
    return f == Surface::none || std::fabs(offset(contact_of(terrain, f), radius, Vector3(p)).value) <= tolerance;
  });
}

/// The seam of a face and an edge is a straight line, all but level perhaps where they are all but upright.
std::optional<Height> height_on_straight_seam(const Terrain& terrain, double radius, const Surface::Edge& edge, Point3 p) {
  if (edge.kind != Surface::EdgeKind::seam || edge.curve != Curve::line) return std::nullopt;
  Contact<double> line = contact_of(terrain, edge.feature[0]), face = contact_of(terrain, edge.feature[1]);
  if (line.kind == FeatureKind::face) std::swap(line, face);
  if (line.kind != FeatureKind::edge || face.kind != FeatureKind::face) return std::nullopt;
  const Vector3 v = Vector3(p) - line.at - radius * face.direction;
  const double flat = std::hypot(line.direction.x, line.direction.y);
  const double along = (v.x * line.direction.x + v.y * line.direction.y) / (flat * flat);
  return Height{line.at.z + radius * face.direction.z + along * line.direction.z, std::fabs(line.direction.z) / flat};
}

double height_on_edge(const Terrain& terrain, double radius, const Surface::Edge& edge, Point3 p) {
  std::array<Height, 2> found;
  std::size_t count = 0;
  for (const Surface::Index feature : edge.feature) {
    if (feature != Surface::none) found[count++] = height(contact_of(terrain, feature), radius, p);
  }
  if (count == 0) return p.z;
  if (count == 1) return found[0].z;
  const auto [a, b] = found;
  const std::optional<Height> seam = height_on_straight_seam(terrain, radius, edge, p);
  if (seam && seam->slope < std::min(a.slope, b.slope)) return seam->z;
  // Of nearly the same height the less steep one is known the better.
  const bool first =
      std::fabs(a.z - b.z) <= 0x1p-14 * radius ? a.slope <= b.slope : std::fabs(a.z - p.z) <= std::fabs(b.z - p.z);
  return first ? a.z : b.z;
}

}  // namespace krepl::terrain
