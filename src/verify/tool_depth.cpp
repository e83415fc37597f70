#include "verify/tool_depth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace krepl::verify {
namespace {

constexpr double lowest = -std::numeric_limits<double>::infinity();
constexpr double golden = 0.6180339887498949;

/// The greatest value of a concave function over an interval, and where it is.
template <class Function>
double greatest(double low, double high, const Function& f, double* where = nullptr) {
  double best = f(low), best_at = low;
  const auto offer = [&](double t, double value) {
    if (value > best) best = value, best_at = t;
  };
  offer(high, f(high));
  double a = high - golden * (high - low), b = low + golden * (high - low), fa = f(a), fb = f(b);
  for (int step = 0; step < 80 && a < b; ++step) {
    offer(a, fa), offer(b, fb);
    if (fa < fb)
      low = a, a = b, fa = fb, b = low + golden * (high - low), fb = f(b);
    else
      high = b, b = a, fb = fa, a = high - golden * (high - low), fa = f(a);
  }
  if (where != nullptr) *where = best_at;
  return best;
}

}  // namespace

ToolDepth::ToolDepth(const Solid& solid, const Cutter& cutter)
    : solid_(solid),
      cutter_(cutter),
      steepest_(cutter.angle() > 0 ? std::numbers::pi / 2 - cutter.angle() * std::numbers::pi / 360
                                   : std::numbers::pi / 2) {}

/// Of a side within reach of the axis, the greatest height above the tool's lower side.
double ToolDepth::above_side(Space<double> a, Space<double> b, Space<double> tip) const {
  const double dx = b.x - a.x, dy = b.y - a.y, length = dx * dx + dy * dy, radius = cutter_.radius();
  const auto value = [&](double t) {
    const double x = a.x + t * dx - tip.x, y = a.y + t * dy - tip.y;
    return a.z + t * (b.z - a.z) - tip.z - cutter_.height(std::min(std::hypot(x, y), radius));
  };
  if (length == 0) return std::hypot(a.x - tip.x, a.y - tip.y) <= radius ? std::max(value(0), value(1)) : lowest;
  const double foot = ((tip.x - a.x) * dx + (tip.y - a.y) * dy) / length;
  const double cross = ((tip.x - a.x) * dy - (tip.y - a.y) * dx), squared = radius * radius - cross * cross / length;
  if (squared < 0) return lowest;
  const double half = std::sqrt(squared / length), low = std::max(0.0, foot - half), high = std::min(1.0, foot + half);
  return low <= high ? greatest(low, high, value) : lowest;
}

/// Of the plane's highest point above the tool, straight uphill from the axis, if it is within the triangle: else a
/// side has it.
double ToolDepth::above_face(const std::array<Space<double>, 3>& c, Space<double> tip) const {
  const double ux = c[1].x - c[0].x, uy = c[1].y - c[0].y, uz = c[1].z - c[0].z;
  const double vx = c[2].x - c[0].x, vy = c[2].y - c[0].y, vz = c[2].z - c[0].z, area = ux * vy - uy * vx;
  if (area == 0) return lowest;
  const double gx = (uz * vy - uy * vz) / area, gy = (ux * vz - uz * vx) / area, slope = std::hypot(gx, gy);
  double r = 0;
  greatest(
      0, cutter_.radius(), [&](double at) { return slope * at - cutter_.height(at); }, &r);
  const double ex = tip.x - c[0].x + (slope > 0 ? gx / slope * r : 0),
               ey = tip.y - c[0].y + (slope > 0 ? gy / slope * r : 0);
  const double v = (ex * vy - ey * vx) / area, w = (ux * ey - uy * ex) / area;
  if (v < 0 || w < 0 || v + w > 1) return lowest;
  return c[0].z + v * uz + w * vz - tip.z - cutter_.height(r);
}

double ToolDepth::above(std::size_t triangle, Space<double> tip) const {
  const std::array<Space<double>, 3> c = solid_.corners(triangle);
  return std::max(
      {above_face(c, tip), above_side(c[0], c[1], tip), above_side(c[1], c[2], tip), above_side(c[2], c[0], tip)});
}

/// The least distance of a point, relative to the tip, to the tangent planes of the tool: of the shank, and of the
/// corner at all its angles, the last of which is that of the flank and the first that of the flat.
double ToolDepth::depth_of(Space<double> q) const {
  const double r = std::hypot(q.x, q.y), corner = cutter_.corner_radius();
  const double out = r - cutter_.flat_radius(), down = corner - q.z;
  const double angle = std::clamp(std::atan2(out, down), 0.0, steepest_);
  const double lower = std::min({corner - (out * std::sin(angle) + down * std::cos(angle)), corner - down,
                                 corner - (out * std::sin(steepest_) + down * std::cos(steepest_))});
  return std::min(cutter_.radius() - r, lower);
}

double ToolDepth::depth_of_triangle(std::size_t triangle, Space<double> tip) const {
  const std::array<Space<double>, 3> c = solid_.corners(triangle);
  const auto over = [&](double s) {
    return greatest(0, 1 - s, [&](double t) {
      const auto mix = [&](double a, double b, double d) { return a + s * (b - a) + t * (d - a); };
      return depth_of({mix(c[0].x, c[1].x, c[2].x) - tip.x, mix(c[0].y, c[1].y, c[2].y) - tip.y,
                       mix(c[0].z, c[1].z, c[2].z) - tip.z});
    });
  };
  return greatest(0, 1, over);
}

double ToolDepth::at(Space<double> tip, double tolerance) const {
  double deepest = 0;
  const double radius = cutter_.radius();
  Box3 box;
  box.add(tip.x, tip.y, tip.z);
  box.grow(radius);
  solid_.tree().for_each_near(box, [&](std::uint32_t t) {
    double x0 = solid_.corners(t)[0].x, x1 = x0, y0 = solid_.corners(t)[0].y, y1 = y0, top = lowest;
    for (const Space<double>& p : solid_.corners(t))
      x0 = std::min(x0, p.x), x1 = std::max(x1, p.x), y0 = std::min(y0, p.y), y1 = std::max(y1, p.y),
      top = std::max(top, p.z);
    const double dx = std::max({x0 - tip.x, tip.x - x1, 0.0}), dy = std::max({y0 - tip.y, tip.y - y1, 0.0});
    const double off = std::hypot(dx, dy);
    if (off > radius || top - cutter_.height(off) <= tip.z + tolerance) return;
    if (above(t, tip) > tolerance) deepest = std::max(deepest, depth_of_triangle(t, tip));
  });
  return deepest;
}

}  // namespace krepl::verify
