#pragma once

#include "terrain/drop_cutter_bound.hpp"
#include "terrain/drop_cutter_profile.hpp"

namespace krepl::drop {

// Upper bounds of the height of a tip that touches part of the terrain; -infinity for parts farther than R from the
// place.
//
// With f the profile and q relative to the place, the tip is at z(q) - f(|q|). Hence:
//   by the top     top - f at the part's point nearest to the axis;
//   by the plane   for any vector v, f(|q|) >= v . q - f*(|v|) with f*(s) = the greatest of s r - f(r), so the tip is
//   at
//                  plane(0) + f*(|v|) + (slope - v) . q at most. The v taken is the slope of the tool where it would
//                  touch the whole plane, moved into the part: the plane's own slope if that point is inside, so that
//                  nothing is lost.
//
// For many places p of a rectangle about the axis, heights relative to a plane of slope w through it: |q - p| is less than
// |q| by what the nearest place is nearer, and v . (q - p) - w . p rises by (v - w) . p at most.
//
// All hold as well for a profile below the tool's. The one taken is nowhere steeper than `steepest`, so that
// coordinates that are off cost little.

/// What the bounds need to know of a cutter. All lengths are in units of Scale::unit.
struct ProfileBound {
  /// Heights above are sums of a few products of a slope below 2 * steepest and a length below 2 R, in single
  /// precision.
  static constexpr double slack_per_radius = 0x1p-16;

  float radius, squared_up, blur;
  float flat, corner, corner_squared, slope, end, end_height, rim_height;

  ProfileBound(const ProfileTool& tool, double inverse_unit, double moved)
      : radius(float(tool.radius * inverse_unit)),
        squared_up(radius * radius * (1 + 0x1p-20f)),
        blur(float(moved * inverse_unit)) {
    const double given = tool.profile.flank ? tool.profile.slope : steepest;
    const Profile<double> below(tool.radius, tool.profile.flat, tool.profile.corner, std::min(given, double(steepest)));
    const bool rises = tool.profile.flank || tool.profile.corner > 0;
    flat = float(below.flat * inverse_unit), corner = float(below.corner * inverse_unit);
    corner_squared = corner * corner, slope = float(below.slope), end = float(below.end * inverse_unit);
    end_height = float(below.end_height * inverse_unit);
    rim_height = rises ? float(below.height(tool.radius) * inverse_unit) : 0;
  }

  /// The profile at a distance; of a flat tool 0 up to the rim and beyond.
  Float4 height(Float4 distance) const {
    const Float4 zero = 0.f;
    const Float4 out = min(max(distance - flat, zero), Float4(end - flat));
    const Float4 bend = max(Float4(corner_squared) - out * out, zero);
    const Float4 in_corner = corner > 0 ? out * out / (Float4(corner) + sqrt(bend)) : zero;
    return in_corner + Float4(slope) * max(min(distance, Float4(radius)) - end, zero);
  }
  /// f*(s)
  Float4 conjugate(Float4 s) const {
    const Float4 in_corner = Float4(flat) * s + Float4(corner) * s * s / (Float4(1.f) + sqrt(Float4(1.f) + s * s));
    return select(s < Float4(slope), in_corner, Float4(radius) * s - rim_height);
  }
  /// Where the tool touches the whole plane.
  void touch_plane(Float4 slope_x, Float4 slope_y, Float4& ex, Float4& ey) const {
    const Float4 squared = slope_x * slope_x + slope_y * slope_y, s = sqrt(squared);
    const Float4 r =
        select(s < Float4(slope), Float4(flat) + Float4(corner) * s / sqrt(Float4(1.f) + squared), Float4(radius));
    const Float4 pull = r / max(s, Float4(0x1p-40f));
    ex = slope_x * pull, ey = slope_y * pull;
  }
  /// A slope of the tool at e, the one nearest to that of the plane if there are several.
  void tangent(Float4 ex, Float4 ey, Float4 slope_x, Float4 slope_y, Float4& vx, Float4& vy) const {
    const Float4 zero = 0.f;
    const Float4 r = sqrt(ex * ex + ey * ey), inverse = Float4(1.f) / max(r, Float4(0x1p-60f));
    const Float4 out = max(min(r, Float4(radius)) - flat, zero);
    const Float4 bend = max(Float4(corner_squared) - out * out, Float4(0x1p-100f));
    Float4 rise = select(out < Float4(end - flat), out / sqrt(bend), select(zero < out, Float4(slope), zero));
    const Float4 along = (slope_x * ex + slope_y * ey) * inverse;
    rise = select(r >= Float4(radius * (1 - 0x1p-20f)), max(rise, along), rise);
    rise = min(rise, Float4(steepest)) * inverse;
    vx = ex * rise, vy = ey * rise;
  }
};

/// How far the places of a rectangle are from its middle.
inline Float4 half_x(const OnePlace&) { return 0.f; }
inline Float4 half_y(const OnePlace&) { return 0.f; }
inline Float4 half_x(const ManyPlaces& spread) { return spread.half_x; }
inline Float4 half_y(const ManyPlaces& spread) { return spread.half_y; }

/// `touched` whether the tool touches the plane within the part, at e; `plane` its height at the place; `rise(gx, gy)`
/// how much a plane of that slope through the place rises at most over the part.
template <class Spread, class Rise>
Float4 lesser_bound(const ProfileBound& tool, const Spread& spread, Float4 top, Float4 far_x, Float4 far_y, Float4 touched, Float4 ex,
                    Float4 ey, Float4 plane, Float4 slope_x, Float4 slope_y, const Rise& rise) {
  const Float4 zero = 0.f;
  const Float4 near_x = max(far_x - half_x(spread) - tool.blur, zero), near_y = max(far_y - half_y(spread) - tool.blur, zero);
  const Float4 d2 = near_x * near_x + near_y * near_y;
  Float4 by_top = top - tool.height(sqrt(d2));
  Float4 vx, vy;
  tool.tangent(ex, ey, slope_x, slope_y, vx, vy);
  vx = select(touched, slope_x, vx), vy = select(touched, slope_y, vy);
  Float4 by_plane = plane + tool.conjugate(sqrt(vx * vx + vy * vy)) + rise(slope_x - vx, slope_y - vy);
  if constexpr (Spread::wide) {
    by_top = by_top + (std::abs(spread.slope_x) * spread.half_x + std::abs(spread.slope_y) * spread.half_y);
    by_plane = by_plane + absolute(vx - spread.slope_x) * spread.half_x + absolute(vy - spread.slope_y) * spread.half_y;
  }
  return select(Float4(tool.squared_up) >= d2, min(by_top, by_plane), Float4(-float_infinity));
}

/// The rise over what of a rectangle is within the square about the tool, over all its places.
struct SquareRise {
  Float4 x0, x1, y0, y1;
  template <class Spread>
  SquareRise(const ProfileBound& tool, const Spread& spread, Float4 x0_, Float4 x1_, Float4 y0_, Float4 y1_) {
    const Float4 side = tool.radius * (1 + 0x1p-20f) + tool.blur, zero = 0.f;
    const Float4 side_x = side + half_x(spread), side_y = side + half_y(spread);
    x0 = min(max(x0_, zero - side_x), side_x), x1 = min(max(x1_, zero - side_x), side_x);
    y0 = min(max(y0_, zero - side_y), side_y), y1 = min(max(y1_, zero - side_y), side_y);
  }
  Float4 operator()(Float4 gx, Float4 gy) const { return max(gx * x0, gx * x1) + max(gy * y0, gy * y1); }
};

template <class Spread>
Float4 bound(const ProfileBound& tool, const FourBlocks& p, const Spread& spread) {
  const Float4 zero = 0.f, half = 0.5f;
  const SquareRise rise(tool, spread, p.x0, p.x1, p.y0, p.y1);
  Float4 ex, ey;
  tool.touch_plane(p.slope_x, p.slope_y, ex, ey);
  const Float4 qx = min(max(ex, rise.x0), rise.x1), qy = min(max(ey, rise.y0), rise.y1);
  const Float4 touched = (absolute(qx - ex) < Float4(0x1p-100f)) & (absolute(qy - ey) < Float4(0x1p-100f));
  const Float4 plane = p.level - p.slope_x * (half * (p.x0 + p.x1)) - p.slope_y * (half * (p.y0 + p.y1));
  return lesser_bound(tool, spread, p.top, max(p.x0, zero - p.x1), max(p.y0, zero - p.y1), touched, qx, qy, plane, p.slope_x,
                      p.slope_y, rise);
}

template <class Spread>
Float4 bound(const ProfileBound& tool, const FourTriangles& p, const Spread& spread) {
  const Float4 zero = 0.f;
  const Float4 x0 = min(min(p.ax, p.bx), p.cx), x1 = max(max(p.ax, p.bx), p.cx);
  const Float4 y0 = min(min(p.ay, p.by), p.cy), y1 = max(max(p.ay, p.by), p.cy);
  const SquareRise square(tool, spread, x0, x1, y0, y1);
  Float4 ex, ey;
  tool.touch_plane(p.slope_x, p.slope_y, ex, ey);
  Nearest nearest(ex, ey);
  nearest.side(p.ax, p.ay, p.bx, p.by);
  nearest.side(p.bx, p.by, p.cx, p.cy);
  nearest.side(p.cx, p.cy, p.ax, p.ay);
  const Float4 qx = nearest.x(), qy = nearest.y();
  const Float4 touched = (absolute(qx - ex) < Float4(0x1p-100f)) & (absolute(qy - ey) < Float4(0x1p-100f));
  const Float4 plane = p.z - p.slope_x * p.ax - p.slope_y * p.ay;
  const auto rise = [&](Float4 gx, Float4 gy) {
    const auto at = [&](Float4 x, Float4 y) { return gx * x + gy * y; };
    return min(square(gx, gy), max(max(at(p.ax, p.ay), at(p.bx, p.by)), at(p.cx, p.cy)));
  };
  return lesser_bound(tool, spread, p.top, max(x0, zero - x1), max(y0, zero - y1), touched, qx, qy, plane, p.slope_x, p.slope_y,
                      rise);
}

}  // namespace krepl::drop
