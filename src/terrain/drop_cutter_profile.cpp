// Where cutters other than balls touch vertices, edges and faces.
//
// A tool over p that touches q has its tip at g(q) = z(q) - f(|q - p|), with f its profile. f is convex and does not
// fall, so g is concave over a plane or a line, as it is for a ball, and its greatest value is found piece by piece of
// the profile:
//
//   vertex   the value itself
//   edge     at distance h from the axis, of slope s: where s = f'(r) x / r, with x the way along the edge from its
//   foot and
//            r^2 = h^2 + x^2. Flank of slope m: x = h s / sqrt(m^2 - s^2). Corner of a ball or of a tapered ball:
//            x = s sqrt((c^2 - h^2) / (1 + s^2)). Corner of a bull nose: a root of degree 8 in x, which is one of a
//            monotone function, so that a bracket closes on it. At a vertical side of the tool, x = sqrt(R^2 - h^2)
//   face     of slope s: straight uphill from the axis where f' = s
//
// Where x is wrong by d, g is wrong by d^2 only. Errors in units of u = 2^-53 and of S are those of
// drop_cutter_touch.hpp: double is used where slopes are at most 2^9 and the rim of tool or corner is not near, else
// quadruple precision. What is within R, edges and vertices at exactly R included, is decided in quadruple precision
// whenever double could be wrong.
#include "terrain/drop_cutter_profile.hpp"

#include <algorithm>
#include <cmath>

namespace krepl::drop {
namespace {

using kernel::quad;
using kernel::square_root;

template <class Real>
constexpr bool is_quad = false;
template <>
constexpr bool is_quad<quad> = true;

Profile<quad> profile_in_quad(const ProfileTool& tool) {
  return Profile<quad>::of(tool.radius, tool.profile.corner, tool.given_slope);
}

/// sqrt(a^2 - b^2), or 0 if b is greater.
template <class Real>
Real leg(Real a, Real b) {
  return b < a ? square_root((a - b) * (a + b)) : Real(0);
}

/// Whether double precision tells height and reach of a feature at this distance from the axis.
bool is_near_rim(const Profile<double>& p, double distance, double squared_distance) {
  const double squared = p.radius * p.radius;
  if (squared - squared_distance < budget::rim * squared) return true;
  const double out = distance - p.flat;
  return out > 0 && distance <= p.end && (p.corner - out) * (p.corner + out) < budget::rim * (p.corner * p.corner);
}

/// Where the tool touches a line: how far along it from the foot of the axis, and how far from the axis.
template <class Real>
struct LineTouch {
  Real along, distance;
};

/// The root of out(x) x = slope r(x) sqrt(c^2 - out(x)^2), with out = r - flat: where the corner of a bull nose has the
/// line's slope. The quotient of both sides grows with x, so there is one change of sign.
template <class Real>
Real corner_root(const Profile<Real>& p, Real slope, Real h, Real low, Real high) {
  const auto excess = [&](Real x) {
    const Real r = square_root(h * h + x * x), out = std::min(std::max(r - p.flat, Real(0)), p.corner);
    return out * x - slope * r * square_root((p.corner - out) * (p.corner + out));
  };
  Real at_low = excess(low), at_high = excess(high);
  if (!(at_low < 0)) return low;
  if (!(at_high > 0)) return high;
  // False position, the value at an end that stays being halved; a bisection whenever three steps have not halved the
  // bracket.
  Real width = high - low;
  for (int step = 1, side = 0; step < 400; ++step) {
    Real x = (low * at_high - high * at_low) / (at_high - at_low);
    if (step % 4 == 0) {
      if ((high - low) * 2 > width) x = low + (high - low) / 2;
      width = high - low;
    }
    if (!(x > low && x < high)) {
      x = low + (high - low) / 2;
      if (!(x > low && x < high)) return x;
    }
    const Real value = excess(x);
    if (value == 0) return x;
    if (value < 0) {
      low = x, at_low = value;
      if (side < 0) at_high = at_high / 2;
      side = -1;
    } else {
      high = x, at_high = value;
      if (side > 0) at_low = at_low / 2;
      side = 1;
    }
    if (high - low <= kernel::unit_roundoff<Real> * high) return x;
  }
  return low;
}

/// A line that rises by slope >= 0 at distance h <= R from the axis.
template <class Real>
LineTouch<Real> touch_line(const Profile<Real>& p, Real slope, Real h) {
  if (slope == 0) return {0, h};
  const Real farthest = leg(p.radius, h);
  const Real least = leg(p.end, h);
  if (p.corner > 0 && h < p.end && !(p.flank && slope * p.end > p.slope * least)) {
    Real x;
    if (p.flat == 0)
      x = slope * square_root((p.corner - h) * (p.corner + h) / (1 + slope * slope));
    else
      x = corner_root<Real>(p, slope, h, leg(p.flat, h), least);
    x = std::min(x, least);
    return {x, std::min(square_root(h * h + x * x), p.end)};
  }
  const bool along_flank = p.flank && slope == p.slope && h == 0;  // touches it with its whole length
  if (!(p.flank && (slope < p.slope || along_flank))) return {farthest, p.radius};
  const Real x = along_flank ? least : std::max(least, h * slope / square_root((p.slope - slope) * (p.slope + slope)));
  if (!(x < farthest)) return {farthest, p.radius};
  return {x, std::min(square_root(h * h + x * x), p.radius)};
}

template <class Real>
VertexTouch vertex(Point3 v, Point place, const Profile<Real>& p) {
  const Real x = Real(place.x) - v.x, y = Real(place.y) - v.y, squared = x * x + y * y;
  if (squared > p.radius * p.radius) return {};
  return {double(v.z - p.height(std::min(square_root(squared), p.radius)))};
}

/// `unsure`: set if double precision does not suffice; the result is then none.
template <class Real>
EdgeTouch edge(Point3 a, Point3 b, Point place, const Profile<Real>& p, bool& unsure) {
  const Real dx = Real(b.x) - a.x, dy = Real(b.y) - a.y, dz = Real(b.z) - a.z;
  const Real ex = Real(place.x) - a.x, ey = Real(place.y) - a.y;
  const Real flat = dx * dx + dy * dy;
  if (flat == 0) return {nothing, 0, 3};
  const Real cross = dx * ey - dy * ex, foot = (dx * ex + dy * ey) / flat;
  const Real squared = cross * cross / flat, reach = p.radius * p.radius;
  if constexpr (!is_quad<Real>) {
    // The distance is wrong by 4 u |e| at most.
    if (reach - squared < -budget::rim * reach && ex * ex + ey * ey < budget::far_corner * squared) return {};
    unsure = dz * dz > budget::steep_edge * flat || ex * ex + ey * ey >= budget::far_corner * reach ||
             is_near_rim(p, std::sqrt(squared), squared);
    if (unsure) return {};
  }
  if (squared > reach) {  // by rounding, maybe: an end at R exactly is for touch_vertex() to decide
    return {nothing, 0, squared > reach * (1 + Real(0x1p-100)) ? 0u : 3u};
  }
  const Real length = square_root(flat), slope = kernel::absolute(dz) / length;
  const LineTouch<Real> touch = touch_line(p, slope, std::min(square_root(squared), p.radius));
  const Real uphill = dz < 0 ? -touch.along : touch.along;
  const Real along = foot + uphill / length;
  const unsigned ends = unsigned(along <= 0) | unsigned(along >= 1) << 1;
  if (ends != 0) {
    // At the rim the corner itself may be out of reach by rounding, while the edge is not.
    const Real off = along <= 0 ? -along : along - 1;
    const Real rounding = 8 * kernel::unit_roundoff<Real> * (length + square_root(ex * ex + ey * ey) + p.radius);
    if (touch.distance < p.radius || off * length > rounding) return {nothing, 0, ends};
  }
  return {double(a.z + dz * foot + slope * touch.along - p.height(touch.distance)), double(along), ends};
}

template <class Real>
FaceTouch face(Point3 a, Point3 b, Point3 c, Point place, const Profile<Real>& p, bool& unsure) {
  const Real ux = Real(b.x) - a.x, uy = Real(b.y) - a.y, uz = Real(b.z) - a.z;
  const Real vx = Real(c.x) - a.x, vy = Real(c.y) - a.y, vz = Real(c.z) - a.z;
  const Real nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
  const Real level = nx * nx + ny * ny, normal = level + nz * nz;
  if constexpr (!is_quad<Real>) {
    const double sides = (ux * ux + uy * uy + uz * uz) * (vx * vx + vy * vy + vz * vz);
    unsure = !(nz > 0 && (nz * nz) * (nz * nz) >= budget::face * normal * sides);
    if (unsure) return {};
  }
  if (!(nz > 0)) return {};
  const Real across = square_root(level);
  Real r = p.flat;  // of the touched point; on level ground the axis
  if (across == 0)
    r = 0;
  else if (p.flank ? across > p.slope * nz : p.corner == 0)
    r = p.radius;
  else if (p.corner > 0)
    r = std::min(p.flat + p.corner * (across / square_root(normal)), p.end);
  const Real scale = across == 0 ? Real(0) : r / across;
  const Real ex = Real(place.x) - a.x - nx * scale, ey = Real(place.y) - a.y - ny * scale;
  const Real v = ex * vy - ey * vx, w = ux * ey - uy * ex;
  const unsigned beyond = unsigned(w <= 0) | unsigned(v + w >= nz) << 1 | unsigned(v <= 0) << 2;
  if (beyond != 0) {
    // As for edges: at the rim a side may be out of reach by rounding.
    const Real off = 8 * kernel::unit_roundoff<Real> *
                     (kernel::absolute(Real(place.x) - a.x) + kernel::absolute(Real(place.y) - a.y) + r);
    const Real off_v = off * (kernel::absolute(vx) + kernel::absolute(vy));
    const Real off_w = off * (kernel::absolute(ux) + kernel::absolute(uy));
    if (r < p.radius || w < -off_w || v < -off_v || v + w > nz + off_v + off_w) return {nothing, 0, 0, beyond};
  }
  return {double(a.z + (v * uz + w * vz) / nz - p.height(r)), double(v / nz), double(w / nz), beyond};
}

}  // namespace

VertexTouch touch_vertex(Point3 v, const ProfileTool& tool) {
  const double x = tool.place.x - v.x, y = tool.place.y - v.y, squared = x * x + y * y;
  if (tool.squared - squared < budget::outside * tool.squared) return {};
  const double distance = std::sqrt(squared);
  if (is_near_rim(tool.profile, distance, squared)) return vertex(v, tool.place, profile_in_quad(tool));
  return {v.z - tool.profile.height(distance)};
}

EdgeTouch touch_edge(Point3 a, Point3 b, const ProfileTool& tool) {
  bool unsure = false;
  const EdgeTouch touch = edge(a, b, tool.place, tool.profile, unsure);
  return unsure ? edge(a, b, tool.place, profile_in_quad(tool), unsure) : touch;
}

FaceTouch touch_face(Point3 a, Point3 b, Point3 c, const ProfileTool& tool) {
  bool unsure = false;
  const FaceTouch touch = face(a, b, c, tool.place, tool.profile, unsure);
  return unsure ? face(a, b, c, tool.place, profile_in_quad(tool), unsure) : touch;
}

}  // namespace krepl::drop
