// Which curve an edge of the surface is.
#include <algorithm>

#include "solid/curve.hpp"
#include "terrain/curve.hpp"

namespace krepl::solid {

namespace {

using Kind = Patch::Kind;

std::optional<Curve> plane_section(const Patch& plane, const Patch& other, const Course& course) {
  if (other.kind == Kind::cylinder) return ellipse_through(plane.at, plane.z, other, course);
  const double off = dot(other.at - plane.at, plane.z), square = other.radius * other.radius - off * off;
  if (!(square > 0)) return std::nullopt;
  return circle_through(other.at - off * plane.z, plane.z, std::sqrt(square), course);
}

/// Cylinders of one radius whose axes cross meet in the two planes that halve the angle between them.
std::optional<Curve> cylinder_section(const Patch& one, const Patch& other, const Course& course) {
  const Point3 across = cross(one.z, other.z);
  const double sine_square = dot(across, across);
  if (!(sine_square > 1e-12)) return std::nullopt;
  const Point3 between = other.at - one.at;
  const Point3 crossing = one.at + (dot(cross(between, other.z), across) / sine_square) * one.z;
  const Point3 d = course.over - crossing;
  const Point3 sum = unit(one.z + other.z), difference = unit(one.z - other.z);
  return ellipse_through(crossing, std::fabs(dot(d, sum)) < std::fabs(dot(d, difference)) ? sum : difference, one,
                         course);
}

std::optional<Curve> section(const Patch& one, const Patch& other, const Course& course) {
  if (one.kind == Kind::plane) return plane_section(one, other, course);
  if (other.kind == Kind::plane) return plane_section(other, one, course);
  if (one.kind == Kind::cylinder && other.kind == Kind::cylinder) return cylinder_section(one, other, course);
  if (one.kind != Kind::sphere || other.kind != Kind::sphere) return std::nullopt;
  const Point3 d = other.at - one.at;
  const double square = one.radius * one.radius - dot(d, d) / 4;
  if (!(square > 0)) return std::nullopt;
  return circle_through(one.at + 0.5 * d, d, std::sqrt(square), course);
}

/// The circle in which a cylinder ends at a point of its axis.
Curve end_circle(const Patch& cylinder, const Course& course) {
  const Point3 centre = cylinder.at + dot(course.over - cylinder.at, cylinder.z) * cylinder.z;
  return circle_through(centre, cylinder.z, cylinder.radius, course);
}

std::optional<Curve> true_curve(const Surface& surface, const Surface::Edge& edge, const Patch& one, const Patch& other,
                                const Course& course) {
  if (edge.kind == Surface::EdgeKind::rim) {
    const Surface::Index upper = edge.feature[edge.feature[0] == Surface::none ? 1 : 0];
    return circle_through(surface.terrain().corners(upper).point[0], {0, 0, 1}, surface.radius(), course);
  }
  if (edge.kind == Surface::EdgeKind::valley) return section(one, other, course);
  const Patch& sphere = one.kind == Kind::sphere ? one : other;
  const Patch& cylinder = one.kind == Kind::cylinder ? one : other;
  if (cylinder.kind != Kind::cylinder) return std::nullopt;
  if (sphere.kind == Kind::sphere) return circle_through(sphere.at, cylinder.z, sphere.radius, course);
  return end_circle(cylinder, course);
}

}  // namespace

Curve edge_curve(const Surface& surface, Surface::Index e, Point3 from, Point3 to, bool closed, const Patch& one,
                 const Patch& other, double tolerance) {
  const Surface::Edge edge = surface.edge(e);
  if (!closed && edge.curve == Surface::Curve::line) return line_between(from, to);
  if (edge.curve != Surface::Curve::quartic) {
    const Course course{from, surface.curve(e, 5)[closed ? 1 : 2], to, closed};
    const std::optional<Curve> curve = true_curve(surface, edge, one, other, course);
    // Where the surfaces are nearly tangent their section says little about where on them the edge is.
    if (curve && curve->gap <= tolerance && std::max(deviation(one, *curve), deviation(other, *curve)) <= tolerance)
      return *curve;
  }
  const auto points = [&](int count) {
    std::vector<Point3> found = surface.curve(e, count);
    found.front() = from, found.back() = to;
    return found;
  };
  return fit(points, one, other, tolerance);
}

}  // namespace krepl::solid
