// The upper rung of the drop cutter's closed forms. The same equations as in drop_cutter_touch.hpp; differences of
// coordinates are exact here unless their exponents lie more than 60 apart.
#include "terrain/drop_cutter_touch.hpp"

#include <cmath>

namespace krepl::drop {

using kernel::quad;
using kernel::square_root;

VertexTouch touch_vertex_quad(Point3 v, const Ball& ball) {
  const quad x = quad(ball.place.x) - v.x, y = quad(ball.place.y) - v.y;
  const quad s = quad(ball.radius) * ball.radius - (x * x + y * y);
  if (s < 0) return {};
  return {double(v.z + square_root(s))};
}

EdgeTouch touch_edge_quad(Point3 a, Point3 b, const Ball& ball) {
  const quad dx = quad(b.x) - a.x, dy = quad(b.y) - a.y, dz = quad(b.z) - a.z;
  const quad ex = quad(ball.place.x) - a.x, ey = quad(ball.place.y) - a.y;
  const quad flat = dx * dx + dy * dy;
  if (flat == 0) return {nothing, 0, 3};
  const quad cross = dx * ey - dy * ex, foot = (dx * ex + dy * ey) / flat;
  const quad squared = quad(ball.radius) * ball.radius, s = squared - cross * cross / flat;
  // By rounding, maybe: an end at R exactly is for touch_vertex() to decide.
  if (s < 0) return {nothing, 0, s < -squared * 0x1p-100 ? 0u : 3u};
  const quad length = flat + dz * dz;
  const quad lift = square_root(s / flat / length);
  const quad along = foot + dz * lift;
  if (along <= 0) return {nothing, 0, 1};
  if (along >= 1) return {nothing, 0, 2};
  return {double(a.z + dz * foot + length * lift), double(along), 0};
}

FaceTouch touch_face_quad(Point3 a, Point3 b, Point3 c, const Ball& ball) {
  const quad ux = quad(b.x) - a.x, uy = quad(b.y) - a.y, uz = quad(b.z) - a.z;
  const quad vx = quad(c.x) - a.x, vy = quad(c.y) - a.y, vz = quad(c.z) - a.z;
  const quad nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
  if (!(nz > 0)) return {};
  const quad scale = ball.radius / square_root(nx * nx + ny * ny + nz * nz);
  const quad ex = quad(ball.place.x) - a.x - nx * scale, ey = quad(ball.place.y) - a.y - ny * scale;
  const quad v = ex * vy - ey * vx, w = ux * ey - uy * ex;
  const unsigned beyond = unsigned(w <= 0) | unsigned(v + w >= nz) << 1 | unsigned(v <= 0) << 2;
  if (beyond != 0) return {nothing, 0, 0, beyond};
  return {double(a.z + (v * uz + w * vz) / nz + nz * scale), double(v / nz), double(w / nz), 0};
}

// Places are mostly far from the strip over which a steep face is touched, which is narrow.
FaceTouch touch_face_carefully(Point3 a, Point3 b, Point3 c, const Ball& ball) {
  constexpr double rounding = 0x1p-50;  // of a few operations
  const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
  const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
  const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
  const double normal = std::sqrt(nx * nx + ny * ny + nz * nz);
  const double sides = std::sqrt((ux * ux + uy * uy + uz * uz) * (vx * vx + vy * vy + vz * vz));
  const double of_normal = rounding * sides, of_nz = rounding * (std::abs(ux * vy) + std::abs(uy * vx));
  if (!(normal > 16 * of_normal && nz > of_nz)) return touch_face_quad(a, b, c, ball);
  const double dx = ball.place.x - a.x, dy = ball.place.y - a.y, scale = ball.radius / normal;
  const double ex = dx - nx * scale, ey = dy - ny * scale;
  const double of_e = 2 * ball.radius * of_normal / normal + rounding * (std::abs(dx) + std::abs(dy) + ball.radius);
  const double v = ex * vy - ey * vx, w = ux * ey - uy * ex;
  const double of_products = of_e + rounding * (std::abs(ex) + std::abs(ey));
  const double of_v = of_products * (std::abs(vx) + std::abs(vy)), of_w = of_products * (std::abs(ux) + std::abs(uy));
  const double third = v + w - nz, of_third = of_v + of_w + of_nz + rounding * (std::abs(v) + std::abs(w) + nz);
  if (!(w < -of_w || third > of_third || v < -of_v)) return touch_face_quad(a, b, c, ball);
  return {nothing, 0, 0, unsigned(w <= of_w) | unsigned(third >= -of_third) << 1 | unsigned(v <= of_v) << 2};
}

}  // namespace krepl::drop
