#pragma once

#include <cmath>
#include <limits>

#include "kernel/quad.hpp"
#include "krepl/point.hpp"

namespace krepl::drop {

struct BallBound;

/// A ball on its way down over a place.
struct Ball {
  using Bound = BallBound;
  Point place;
  double radius;
  double squared;  // radius
  /// The height of its lowest point, from that of the point that is spoken of: its centre.
  double tip(double height) const { return height - radius; }
};
inline Ball ball_over(Point place, double radius) { return {place, radius, radius * radius}; }

inline constexpr double nothing = -std::numeric_limits<double>::infinity();

/// The height of the tool (of a ball its centre) when it touches a feature, and the touched point by its parameters on
/// the feature. Everything is a function of the feature's corners in their order and of the tool alone, so that all
/// searches find the same bits.
///
/// Error budget, in units of S = max(R, coordinates), u = 2^-53. A double evaluation is used only where it loses little:
///   vertex   d^2 has relative error 2u, so the height 2u R^2 / sqrt(R^2 - d^2) <= 2^7 u R while R^2 - d^2 >= 2^-12 R^2;
///   edge     the same for the distance from its line; and slope * u * (distance from corner a), slope <= 2^9;
///   face     |n| |d1| |d2| u / n.z^2 * (distance from corner a), with n = d1 x d2 the normal; kept below 2^9 u.
/// That is 2^-43 S at most. The rest is done in quadruple precision.
struct VertexTouch {
  double height = nothing;
};
struct EdgeTouch {
  double height = nothing;
  double along = 0;  // touched point: a + along (b - a), 0 < along < 1
  /// Ends where the ball touches the edge if not between them: 1 for a, 2 for b.
  unsigned ends = 0;
};
struct FaceTouch {
  double height = nothing;
  double v = 0, w = 0;  // touched point: a + v (b - a) + w (c - a), all three weights > 0
  /// Sides beyond which a ball on the face's plane would touch it, or on which, or near which if there is one of these:
  /// bit i for the side from corner i to corner i + 1. The highest touch of the closed triangle is on the face if there is none, else on one of these sides: the height
  /// as a function of the touched point is concave, so it grows along the way to where the plane is touched.
  unsigned beyond = 7;
};

namespace budget {
inline constexpr double rim = 0x1p-12;        // of R^2
inline constexpr double outside = -0x1p-45;   // of R^2: beyond the rim for certain
inline constexpr double far_corner = 0x1p60;  // squared distance of an edge's corner in units of R^2
inline constexpr double steep_edge = 0x1p18;  // slope^2
inline constexpr double face = 0x1p-18;       // of |n|^2 |d1|^2 |d2|^2 for n.z^4
}  // namespace budget

/// The upper rung: the closed forms in quadruple precision.
VertexTouch touch_vertex_quad(Point3 v, const Ball& ball);
EdgeTouch touch_edge_quad(Point3 a, Point3 b, const Ball& ball);
FaceTouch touch_face_quad(Point3 a, Point3 b, Point3 c, const Ball& ball);
/// Of a steep or thin face: in double as far as that tells for certain that the face is not touched inside.
FaceTouch touch_face_carefully(Point3 a, Point3 b, Point3 c, const Ball& ball);

inline VertexTouch touch_vertex(Point3 v, const Ball& ball) {
  const double x = ball.place.x - v.x, y = ball.place.y - v.y;
  const double s = ball.squared - (x * x + y * y);
  if (s >= budget::rim * ball.squared) [[likely]] return {v.z + std::sqrt(s)};
  if (s < budget::outside * ball.squared) return {};
  return touch_vertex_quad(v, ball);
}

/// [engines, section 3]: the cylinder's height h = a.z + m alpha + sqrt(1 + m^2) sqrt(R^2 - beta^2), without square roots of
/// the edge's length. A vertical edge touches with its upper end only.
inline EdgeTouch touch_edge(Point3 a, Point3 b, const Ball& ball) {
  const double dx = b.x - a.x, dy = b.y - a.y, dz = b.z - a.z;
  const double ex = ball.place.x - a.x, ey = ball.place.y - a.y;
  const double flat = dx * dx + dy * dy;
  if (flat == 0) return {nothing, 0, 3};
  const double inverse = 1 / flat;
  const double cross = dx * ey - dy * ex, foot = (dx * ex + dy * ey) * inverse;
  const double s = ball.squared - cross * cross * inverse;
  if (s < budget::rim * ball.squared || dz * dz > budget::steep_edge * flat) [[unlikely]] {
    // The distance from the line is wrong by 4 u |e| at most.
    const bool beyond = s < -budget::rim * ball.squared && ex * ex + ey * ey < budget::far_corner * (ball.squared - s);
    return beyond ? EdgeTouch{} : touch_edge_quad(a, b, ball);
  }
  const double length = flat + dz * dz;
  const double lift = std::sqrt(s * inverse / length);
  const double along = foot + dz * lift;
  if (along <= 0) return {nothing, 0, 1};
  if (along >= 1) return {nothing, 0, 2};
  return {a.z + dz * foot + length * lift, along, 0};
}

/// Corners counter-clockwise seen from above, not vertical.
inline FaceTouch touch_face(Point3 a, Point3 b, Point3 c, const Ball& ball) {
  const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
  const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
  const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
  const double normal = nx * nx + ny * ny + nz * nz;
  const double sides = (ux * ux + uy * uy + uz * uz) * (vx * vx + vy * vy + vz * vz);
  if (!(nz > 0 && (nz * nz) * (nz * nz) >= budget::face * normal * sides)) [[unlikely]] {
    return touch_face_carefully(a, b, c, ball);
  }
  const double scale = ball.radius / std::sqrt(normal);
  const double ex = ball.place.x - a.x - nx * scale, ey = ball.place.y - a.y - ny * scale;
  const double v = ex * vy - ey * vx, w = ux * ey - uy * ex;
  const unsigned beyond = unsigned(w <= 0) | unsigned(v + w >= nz) << 1 | unsigned(v <= 0) << 2;
  if (beyond != 0) return {nothing, 0, 0, beyond};
  const double inverse = 1 / nz;
  return {a.z + (v * uz + w * vz) * inverse + nz * scale, v * inverse, w * inverse, 0};
}

}  // namespace krepl::drop
