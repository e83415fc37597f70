#include "terrain/curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace krepl::terrain {

using FeatureKind = Terrain::FeatureKind;
using Curve = Surface::Curve;

namespace {

/// Directions that differ by less count as parallel or coplanar.
constexpr double parallel = 1e-12;

struct Vector3 {
  double x, y, z;
};
Vector3 operator-(Point3 p, Point3 q) { return {p.x - q.x, p.y - q.y, p.z - q.z}; }
Vector3 operator*(double s, Vector3 v) { return {s * v.x, s * v.y, s * v.z}; }
Vector3 operator+(Vector3 v, Vector3 w) { return {v.x + w.x, v.y + w.y, v.z + w.z}; }
Point3 operator+(Point3 p, Vector3 v) { return {p.x + v.x, p.y + v.y, p.z + v.z}; }
double dot(Vector3 v, Vector3 w) { return v.x * w.x + v.y * w.y + v.z * w.z; }
Vector3 cross(Vector3 v, Vector3 w) { return {v.y * w.z - v.z * w.y, v.z * w.x - v.x * w.z, v.x * w.y - v.y * w.x}; }
double length(Vector3 v) { return std::sqrt(dot(v, v)); }
Vector3 unit(Vector3 v) { return (1 / length(v)) * v; }

struct Contact {
  FeatureKind kind;
  Point3 at;
  Vector3 direction;  // edge: along it; face: its upward normal
};

Contact contact_of(const Terrain& terrain, Surface::Index feature) {
  const auto c = terrain.corners(feature);
  if (c.count == 1) return {FeatureKind::vertex, c.point[0], {0, 0, 0}};
  if (c.count == 2) return {FeatureKind::edge, c.point[0], unit(c.point[1] - c.point[0])};
  Vector3 n = unit(cross(c.point[1] - c.point[0], c.point[2] - c.point[0]));
  if (n.z < 0) n = -1.0 * n;
  return {FeatureKind::face, c.point[0], n};
}

/// Signed distance of a point from what the ball touches, less R, and its gradient.
struct Offset {
  double value;
  Vector3 gradient;
};
Offset offset(const Contact& c, double radius, Point3 p) {
  const Vector3 d = p - c.at;
  if (c.kind == FeatureKind::face) return {dot(d, c.direction) - radius, c.direction};
  const Vector3 away = c.kind == FeatureKind::vertex ? d : d + (-dot(d, c.direction)) * c.direction;
  const double l = length(away);
  return {l - radius, l > 0 ? (1 / l) * away : Vector3{0, 0, 1}};
}

/// The circle along which an edge's cylinder meets the sphere about one of its ends, or another cylinder in line with it.
Point3 on_end_circle(const Terrain& terrain, double radius, const Surface::Edge& edge, Point3 near) {
  const auto a = terrain.corners(edge.feature[0]), b = terrain.corners(edge.feature[1]);
  const auto& line = a.count == 2 ? a : b;
  const auto& other = a.count == 2 ? b : a;
  Point3 center = other.point[0];
  if (other.count == 2 && (other.point[1] == line.point[0] || other.point[1] == line.point[1])) center = other.point[1];
  const Vector3 d = unit(line.point[1] - line.point[0]);
  const Vector3 v = near - center;
  return center + radius * unit(v + (-dot(v, d)) * d);
}

Point3 on_rim(const Contact& c, double radius, Point3 near) {
  Vector3 v = near - c.at;
  if (c.kind == FeatureKind::vertex) {
    v.z = 0;
    return c.at + radius * unit(v);
  }
  const Vector3 aside = unit({-c.direction.y, c.direction.x, 0});
  const double sign = dot(v, aside) < 0 ? -1 : 1;
  const double flat = std::hypot(c.direction.x, c.direction.y);
  const double along = (v.x * c.direction.x + v.y * c.direction.y) / (flat * flat);
  return c.at + (along * c.direction + (sign * radius) * aside);
}

}  // namespace

Curve curve_kind(const Terrain& terrain, const Surface::Edge& edge) {
  if (edge.feature[0] == Surface::none || edge.feature[1] == Surface::none) {
    const Surface::Index upper = edge.feature[0] == Surface::none ? edge.feature[1] : edge.feature[0];
    return upper != Surface::none && terrain.feature_kind(upper) == FeatureKind::vertex ? Curve::circle : Curve::line;
  }
  Contact a = contact_of(terrain, edge.feature[0]), b = contact_of(terrain, edge.feature[1]);
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

Point3 project_to_curve(const Terrain& terrain, double radius, const Surface::Edge& edge, Point3 near) {
  if (edge.feature[0] == Surface::none || edge.feature[1] == Surface::none) {
    const Surface::Index upper = edge.feature[0] == Surface::none ? edge.feature[1] : edge.feature[0];
    return upper == Surface::none ? near : on_rim(contact_of(terrain, upper), radius, near);
  }
  if (edge.kind == Surface::EdgeKind::seam && edge.curve == Curve::circle) return on_end_circle(terrain, radius, edge, near);
  if (edge.kind == Surface::EdgeKind::seam) return near;  // a straight line between its ends
  // Newton's method towards the curve where both distances are R, by the shortest way.
  const Contact a = contact_of(terrain, edge.feature[0]), b = contact_of(terrain, edge.feature[1]);
  Point3 p = near;
  for (int i = 0; i < 20; ++i) {
    const Offset f = offset(a, radius, p), g = offset(b, radius, p);
    const double fg = dot(f.gradient, g.gradient), det = 1 - fg * fg;
    if (!(det > 1e-24)) break;
    const double s = (f.value - fg * g.value) / det, t = (g.value - fg * f.value) / det;
    const Vector3 step = (-s) * f.gradient + (-t) * g.gradient;
    p = p + step;
    if (length(step) <= 4e-16 * (std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z))) break;
  }
  return p;
}

double height_on_edge(const Terrain& terrain, double radius, const Surface::Edge& edge, Point3 p) {
  double nearest = std::numeric_limits<double>::infinity(), height = p.z;
  for (const Surface::Index feature : edge.feature) {
    if (feature == Surface::none) continue;
    const Contact c = contact_of(terrain, feature);
    const Vector3 v = p - c.at;
    double h;
    if (c.kind == FeatureKind::face) {
      h = c.at.z + (radius - c.direction.x * v.x - c.direction.y * v.y) / c.direction.z;
    } else if (c.kind == FeatureKind::vertex) {
      h = c.at.z + std::sqrt(std::max(0.0, radius * radius - v.x * v.x - v.y * v.y));
    } else {
      const double flat = std::hypot(c.direction.x, c.direction.y), m = c.direction.z / flat;
      const double along = (v.x * c.direction.x + v.y * c.direction.y) / flat;
      const double aside = (v.y * c.direction.x - v.x * c.direction.y) / flat;
      h = c.at.z + m * along + std::sqrt(std::max(0.0, radius * radius - aside * aside)) / flat;
    }
    if (std::fabs(h - p.z) < nearest) nearest = std::fabs(h - p.z), height = h;
  }
  return height;
}

}  // namespace krepl::terrain
