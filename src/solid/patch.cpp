#include "solid/patch.hpp"

#include <algorithm>
#include <numbers>
#include <vector>

#include "terrain/curve.hpp"

namespace krepl::solid {

namespace {

constexpr double pi = std::numbers::pi;
constexpr Point3 up{0, 0, 1};

/// Sets x as near to `wanted` as it can be across z, and y.
void turn(Patch& patch, Point3 wanted) {
  patch.x = unit(wanted - dot(wanted, patch.z) * patch.z);
  patch.y = cross(patch.z, patch.x);
}

Point3 any_across(Point3 z) {
  const bool steep = std::fabs(z.z) > 0.5;
  return steep ? Point3{1, 0, 0} : up;
}

double angle_of(double y, double x) {
  const double angle = std::atan2(y, x);
  return angle < 0 ? angle + 2 * pi : angle;
}

/// The least angle between the border's points and a pole; negative if the border crosses the start of longitudes,
/// which it does too if a pole lies inside.
double clearance(const Patch& sphere, std::span<const Point3> border) {
  double least = pi;
  double before = sphere.parameters(border.back()).x;
  for (const Point3 p : border) {
    const Point place = sphere.parameters(p);
    if (std::fabs(place.x - before) > pi) return -1;
    before = place.x;
    least = std::min(least, pi / 2 - std::fabs(place.y));
  }
  return least;
}

}  // namespace

Point Patch::parameters(Point3 p) const {
  const Point3 d = p - at;
  const double u = dot(d, x), v = dot(d, y), w = dot(d, z);
  if (kind == Kind::plane) return {u, v};
  if (kind == Kind::cylinder) return {angle_of(v, u), w};
  return {angle_of(v, u), std::atan2(w, std::hypot(u, v))};
}

Point3 Patch::point(Point q) const {
  if (kind == Kind::plane) return at + q.x * x + q.y * y;
  const Point3 around = std::cos(q.x) * x + std::sin(q.x) * y;
  if (kind == Kind::cylinder) return at + radius * around + q.y * z;
  return at + (radius * std::cos(q.y)) * around + (radius * std::sin(q.y)) * z;
}

double Patch::distance(Point3 p) const {
  const Point3 d = p - at;
  if (kind == Kind::plane) return std::fabs(dot(d, z));
  if (kind == Kind::cylinder) return std::fabs(std::hypot(dot(d, x), dot(d, y)) - radius);
  return std::fabs(length(d) - radius);
}

Patch patch_of(const Terrain& terrain, Terrain::Index feature, double radius) {
  const Terrain::Corners corners = terrain.corners(feature);
  Patch patch;
  patch.at = corners.point[0];
  patch.radius = radius;
  if (corners.count == 1) {
    patch.kind = Patch::Kind::sphere;
  } else if (corners.count == 2) {
    patch.kind = Patch::Kind::cylinder;
    patch.z = unit(corners.point[1] - corners.point[0]);
    turn(patch, -1.0 * up);  // faces lie on the upper half
  } else {
    patch.z = unit(cross(corners.point[1] - corners.point[0], corners.point[2] - corners.point[0]));
    if (patch.z.z < 0) patch.z = -1.0 * patch.z;
    turn(patch, any_across(patch.z));
    patch.at = patch.at + radius * patch.z;
  }
  return patch;
}

std::optional<Patch> turned_away(const Patch& sphere, std::span<const Point3> border) {
  constexpr double enough = 0.3, least = 1e-4;
  constexpr int directions = 16;
  Point3 middle{};
  for (const Point3 p : border) middle = middle + unit(p - sphere.at);
  if (!(length(middle) > 0)) middle = up;
  Patch best = sphere;
  double best_clearance = -1;
  // First axes across the middle of the face, then all others.
  for (int i = 0; i < directions * directions && best_clearance < enough; ++i) {
    const double round = pi * (i % directions) / directions, tilt = pi / 2 * (i / directions) / directions;
    const Point3 m = unit(middle);
    Patch frame = sphere;
    frame.z = m;
    turn(frame, any_across(m));
    const Point3 across = std::cos(round) * frame.x + std::sin(round) * frame.y;
    Patch turned = sphere;
    turned.z = unit(std::cos(tilt) * across + std::sin(tilt) * m);
    if (tilt >= pi / 2) continue;
    turn(turned, -1.0 * m);
    const double clear = clearance(turned, border);
    if (clear > best_clearance) best = turned, best_clearance = clear;
  }
  if (best_clearance < least) return std::nullopt;
  return best;
}

double height_over(const Surface& surface, Surface::Index feature, Point3 p) {
  const Surface::Edge alone{Surface::EdgeKind::rim, Surface::Curve::line, {feature, Surface::none}};
  return terrain::height_on_edge(surface.terrain(), surface.radius(), alone, p);
}

Patch wall_plane(Point3 a, Point3 b) {
  Patch wall;
  wall.at = a;
  wall.x = unit({b.x - a.x, b.y - a.y, 0});
  wall.y = up;
  wall.z = cross(wall.x, wall.y);  // to the right of a to b
  return wall;
}

Patch wall_cylinder(Point3 centre, double radius, Point3 middle) {
  Patch wall;
  wall.kind = Patch::Kind::cylinder;
  wall.at = centre;
  wall.radius = radius;
  turn(wall, centre - middle);
  return wall;
}

}  // namespace krepl::solid
