// With q the touched point and d = q - p in the plane, r = |d|, the height z(q) - f(r) changes with the place p by
// f'(r) d / r, as moving q along its feature changes nothing to first order. At the rim of the tool f has no slope.
// There the feature says it:
//
//   face    the tool moves along with the plane: its slope
//   edge    of slope s, q is x further uphill than the foot of the axis, x = sqrt(R^2 - h^2): s x changes by s d / x,
//   which is
//           f'(r) d / r as well where there is a slope, because of s = f'(r) x / r
//   vertex  only on the border of what is within reach, where any slope of the tool will do
#include "terrain/drop_cutter_part.hpp"

#include <algorithm>
#include <cmath>

namespace krepl::drop {
namespace {

/// f'(r) / r; at the axis of a cone, where there is no one slope, that of a level tool.
double pull(const ProfileTool& tool, double r) {
  const Profile<double>& p = tool.profile;
  if (!(r > p.flat) || r == 0) return 0;
  if (r > p.end) return p.slope / r;
  const double out = r - p.flat, under = (p.corner - out) * (p.corner + out);
  return out / (std::sqrt(std::max(under, 0x1p-100 * p.corner * p.corner)) * r);
}

Point slope_at_edge(Point3 a, Point3 b, double along, const ProfileTool& tool) {
  const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z, length = std::hypot(ux, uy);
  const double dx = a.x + along * ux - tool.place.x, dy = a.y + along * uy - tool.place.y, r = std::hypot(dx, dy);
  double factor = pull(tool, std::min(r, tool.radius));
  if (uz != 0 && r >= tool.radius * (1 - 0x1p-34)) {
    const double x = (dx * ux + dy * uy) / length;
    if (x * uz > 0) factor = uz / length / x;
  }
  return {factor * dx, factor * dy};
}

}  // namespace

PartTouch touch_part(const Part& p, const ProfileTool& tool) {
  PartTouch best;
  FaceTouch face;
  if (!p.vertical) face = touch_face(p.corner[0], p.corner[1], p.corner[2], tool);
  if (face.height != nothing) {
    const Point3 a = p.corner[0], b = p.corner[1], c = p.corner[2];
    const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z, vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    const double area = ux * vy - uy * vx;
    best = {face.height, {(uz * vy - uy * vz) / area, (ux * vz - uz * vx) / area}};
  }
  if (face.beyond == 0) return best;
  unsigned corners = 0;
  for (unsigned i = 0; i < 3; ++i) {
    if ((face.beyond & (1u << i)) == 0) continue;
    const unsigned next = i == 2 ? 0 : i + 1;
    const unsigned a = p.vertex[i] < p.vertex[next] ? i : next, b = a ^ i ^ next;
    const EdgeTouch edge = touch_edge(p.corner[a], p.corner[b], tool);
    if (edge.height > best.height) best = {edge.height, slope_at_edge(p.corner[a], p.corner[b], edge.along, tool)};
    if (edge.ends & 1) corners |= 1u << a;
    if (edge.ends & 2) corners |= 1u << b;
  }
  for (unsigned i = 0; i < 3; ++i) {
    if ((corners & (1u << i)) == 0) continue;
    const double height = touch_vertex(p.corner[i], tool).height;
    if (!(height > best.height)) continue;
    const double dx = p.corner[i].x - tool.place.x, dy = p.corner[i].y - tool.place.y;
    const double factor = pull(tool, std::min(std::hypot(dx, dy), tool.radius));
    best = {height, {factor * dx, factor * dy}};
  }
  return best;
}

}  // namespace krepl::drop
