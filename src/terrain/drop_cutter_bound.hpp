#pragma once

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "kernel/outward_rounding.hpp"
#include "terrain/drop_cutter_touch.hpp"

namespace krepl::drop {

/// Four numbers in single precision.
#ifdef __SSE2__
struct Float4 {
  __m128 v;
  Float4() = default;
  Float4(__m128 lanes) : v(lanes) {}
  Float4(float all) : v(_mm_set1_ps(all)) {}
  static Float4 load(const float* p) { return _mm_loadu_ps(p); }
  static Float4 from_doubles(const double* p) {
    return _mm_movelh_ps(_mm_cvtpd_ps(_mm_loadu_pd(p)), _mm_cvtpd_ps(_mm_loadu_pd(p + 2)));
  }
  void store(float* p) const { _mm_storeu_ps(p, v); }
  friend Float4 operator+(Float4 a, Float4 b) { return _mm_add_ps(a.v, b.v); }
  friend Float4 operator-(Float4 a, Float4 b) { return _mm_sub_ps(a.v, b.v); }
  friend Float4 operator*(Float4 a, Float4 b) { return _mm_mul_ps(a.v, b.v); }
  friend Float4 operator/(Float4 a, Float4 b) { return _mm_div_ps(a.v, b.v); }
  friend Float4 min(Float4 a, Float4 b) { return _mm_min_ps(a.v, b.v); }
  friend Float4 max(Float4 a, Float4 b) { return _mm_max_ps(a.v, b.v); }
  friend Float4 sqrt(Float4 a) { return _mm_sqrt_ps(a.v); }
  /// 1 / sqrt(a), roughly.
  friend Float4 rough_inverse_root(Float4 a) { return _mm_rsqrt_ps(a.v); }
  friend Float4 rough_inverse(Float4 a) { return _mm_rcp_ps(a.v); }
  friend Float4 operator>=(Float4 a, Float4 b) { return _mm_cmpge_ps(a.v, b.v); }
  friend Float4 operator<(Float4 a, Float4 b) { return _mm_cmplt_ps(a.v, b.v); }
  friend Float4 is_number(Float4 a) { return _mm_cmpord_ps(a.v, a.v); }
  /// Of masks, which comparisons give.
  friend Float4 operator&(Float4 a, Float4 b) { return _mm_and_ps(a.v, b.v); }
  friend Float4 select(Float4 mask, Float4 yes, Float4 no) {
    return _mm_or_ps(_mm_and_ps(mask.v, yes.v), _mm_andnot_ps(mask.v, no.v));
  }
  /// A bit for each lane of a mask.
  friend unsigned bits(Float4 mask) { return unsigned(_mm_movemask_ps(mask.v)); }
};
#else
struct Float4 {
  std::array<float, 4> v;
  Float4() = default;
  Float4(float all) : v{all, all, all, all} {}
  template <class Lane>
  static Float4 each(Lane&& lane) {
    Float4 r;
    for (std::size_t k = 0; k < 4; ++k) r.v[k] = lane(k);
    return r;
  }
  static Float4 load(const float* p) { return each([&](auto k) { return p[k]; }); }
  static Float4 from_doubles(const double* p) { return each([&](auto k) { return float(p[k]); }); }
  void store(float* p) const { std::copy(v.begin(), v.end(), p); }
  friend Float4 operator+(Float4 a, Float4 b) { return each([&](auto k) { return a.v[k] + b.v[k]; }); }
  friend Float4 operator-(Float4 a, Float4 b) { return each([&](auto k) { return a.v[k] - b.v[k]; }); }
  friend Float4 operator*(Float4 a, Float4 b) { return each([&](auto k) { return a.v[k] * b.v[k]; }); }
  friend Float4 operator/(Float4 a, Float4 b) { return each([&](auto k) { return a.v[k] / b.v[k]; }); }
  friend Float4 min(Float4 a, Float4 b) { return each([&](auto k) { return a.v[k] < b.v[k] ? a.v[k] : b.v[k]; }); }
  friend Float4 max(Float4 a, Float4 b) { return each([&](auto k) { return a.v[k] > b.v[k] ? a.v[k] : b.v[k]; }); }
  friend Float4 sqrt(Float4 a) { return each([&](auto k) { return std::sqrt(a.v[k]); }); }
  friend Float4 rough_inverse_root(Float4 a) { return each([&](auto k) { return 1 / std::sqrt(a.v[k]); }); }
  friend Float4 rough_inverse(Float4 a) { return each([&](auto k) { return 1 / a.v[k]; }); }
  friend Float4 operator>=(Float4 a, Float4 b) { return each([&](auto k) { return a.v[k] >= b.v[k] ? 1.f : 0.f; }); }
  friend Float4 operator<(Float4 a, Float4 b) { return each([&](auto k) { return a.v[k] < b.v[k] ? 1.f : 0.f; }); }
  friend Float4 is_number(Float4 a) { return each([&](auto k) { return a.v[k] == a.v[k] ? 1.f : 0.f; }); }
  friend Float4 operator&(Float4 a, Float4 b) { return each([&](auto k) { return a.v[k] * b.v[k]; }); }
  friend Float4 select(Float4 mask, Float4 yes, Float4 no) {
    return each([&](auto k) { return mask.v[k] != 0 ? yes.v[k] : no.v[k]; });
  }
  friend unsigned bits(Float4 mask) {
    unsigned b = 0;
    for (unsigned k = 0; k < 4; ++k) b |= unsigned(mask.v[k] != 0) << k;
    return b;
  }
};
#endif

inline Float4 absolute(Float4 a) { return max(a, Float4(0.f) - a); }

inline constexpr float float_infinity = std::numeric_limits<float>::infinity();

/// Rounded to single precision, up or down.
inline float up(double x) { return kernel::float_above(x); }
inline float down(double x) { return kernel::float_below(x); }

/// What the bounds need to know of the ball. All lengths in bounds are in units of Scale::unit.
struct BallBound {
  static constexpr double slack_per_radius = 0;
  float radius, squared, squared_up;
  float blur;  // what rounding to single precision may have moved coordinates relative to the place by
  BallBound(const Ball& ball, double inverse_unit, double moved) : BallBound(ball.radius * inverse_unit, moved) {}
  BallBound(double r, double moved)
      : radius(float(r)), squared(radius * radius), squared_up(squared * (1 + 0x1p-20f)), blur(float(moved)) {}
};

/// Slopes beyond it are not used in bounds, so that coordinates that are off cost little height: in x and y the slope, and
/// that of the ball's tangent, which is below 4.
inline constexpr float steepest = 8;
inline constexpr double slack_per_move = 2 * (8 + 4);

/// Four blocks of the terrain as the bounds see them: over a rectangle [x0, x1] x [y0, y1], in coordinates relative to the
/// place, below the height `top` and below the plane  level + slope . (q - middle of the rectangle).
struct FourBlocks {
  Float4 top, level, slope_x, slope_y;
  Float4 x0, x1, y0, y1;
};

/// Four triangles a b c, counter-clockwise: on the plane that has height z at a, and nowhere above `top`.
struct FourTriangles {
  Float4 top, z, slope_x, slope_y;
  Float4 ax, ay, bx, by, cx, cy;
};

/// What rounding inside bound() may cost over a rectangle of the given sides; to be added to `level`.
inline double bound_rounding(double width, double height, double slope_x, double slope_y) {
  return 0x1p-18 * (width * (1 + std::abs(slope_x)) + height * (1 + std::abs(slope_y)));
}

/// One place: no spread.
struct OnePlace {
  static constexpr bool wide = false;
};
/// All places within a rectangle about the place, heights there being taken relative to a sloping plane through it.
struct ManyPlaces {
  static constexpr bool wide = true;
  float half_x, half_y;    // sides of the rectangle
  float slope_x, slope_y;  // of the plane
};

// Upper bounds of (height of a ball that touches a part of the terrain) - R; -infinity for parts farther than R from the
// place. Subtracting R keeps the digits where R is much larger than the terrain.
//
// For a point q of a part, with e = q - place and rho = sqrt(R^2 - e^2), the ball that touches q is at z(q) + rho. Hence:
//   by the top     top + rho at the point of the part's rectangle nearest to the place;
//   by the plane   f(q) = plane(q) + rho(q) is concave, so its tangent at any q0 bounds it over the part. The q0 taken is
//                  where the ball would touch the whole plane, e = R slope / sqrt(1 + slope^2), moved into the part: there
//                  the tangent rises little, or out of the part.
// For many places: f is concave in q and the place together, and its tangent rises by e / rho with the place.

/// Where a ball touches the whole plane, relative to the place.
inline void touch_plane(const BallBound& ball, Float4 slope_x, Float4 slope_y, Float4& ex, Float4& ey) {
  const Float4 pull = Float4(ball.radius) * rough_inverse_root(Float4(1.f) + slope_x * slope_x + slope_y * slope_y);
  ex = slope_x * pull, ey = slope_y * pull;
}

/// The lesser bound. `far_x`, `far_y`: how far the part's rectangle is off, negative if it is not; `plane`: its height at
/// q0; `rise(gx, gy)`: how much a plane of that slope through q0 rises at most over the part.
template <class Spread, class Rise>
Float4 lesser_bound(const BallBound& ball, const Spread& spread, Float4 top, Float4 far_x, Float4 far_y, Float4 ex, Float4 ey,
                    Float4 plane, Float4 slope_x, Float4 slope_y, const Rise& rise) {
  const Float4 zero = 0.f, shrink = 1 - 0x1p-20f, radius = ball.radius;
  if constexpr (Spread::wide) far_x = far_x - spread.half_x, far_y = far_y - spread.half_y;
  const Float4 near_x = max(far_x - ball.blur, zero), near_y = max(far_y - ball.blur, zero);
  const Float4 d2 = near_x * near_x + near_y * near_y;
  const Float4 s = Float4(ball.squared_up) - d2;
  Float4 by_top = top - shrink * d2 / (radius + sqrt(max(s, zero)));

  const Float4 e2 = ex * ex + ey * ey, rho2 = Float4(ball.squared) - e2;
  const Float4 least = 0x1p-4f * ball.squared;  // below it the tangent is too steep for single precision
  const Float4 rho = sqrt(max(rho2, least));
  const Float4 inverse = Float4(1.f) / (rho * (radius + rho));
  const Float4 tilt = (radius + rho) * inverse;  // 1 / rho
  const Float4 tilt_x = ex * tilt, tilt_y = ey * tilt;
  Float4 by_plane = plane - shrink * e2 * (rho * inverse) + rise(slope_x - tilt_x, slope_y - tilt_y);
  if constexpr (Spread::wide) {
    by_top = by_top + (std::abs(spread.slope_x) * spread.half_x + std::abs(spread.slope_y) * spread.half_y);
    by_plane = by_plane + absolute(tilt_x - spread.slope_x) * spread.half_x + absolute(tilt_y - spread.slope_y) * spread.half_y;
  }
  const Float4 both = min(by_top, select(rho2 >= least, by_plane, by_top));
  return select(s >= zero, both, Float4(-float_infinity));
}

template <class Spread>
Float4 bound(const BallBound& ball, const FourBlocks& p, const Spread& spread) {
  const Float4 zero = 0.f, half = 0.5f;
  Float4 ex, ey;
  touch_plane(ball, p.slope_x, p.slope_y, ex, ey);
  ex = min(max(ex, p.x0), p.x1), ey = min(max(ey, p.y0), p.y1);
  const Float4 plane = p.level + p.slope_x * (ex - half * (p.x0 + p.x1)) + p.slope_y * (ey - half * (p.y0 + p.y1));
  return lesser_bound(ball, spread, p.top, max(p.x0, zero - p.x1), max(p.y0, zero - p.y1), ex, ey, plane, p.slope_x, p.slope_y,
                      [&](Float4 gx, Float4 gy) {
                        return max(gx * (p.x1 - ex), gx * (p.x0 - ex)) + max(gy * (p.y1 - ey), gy * (p.y0 - ey));
                      });
}

/// The nearest point of a triangle, roughly; counter-clockwise.
class Nearest {
 public:
  Nearest(Float4 x, Float4 y) : x_(x), y_(y), best_x_(x), best_y_(y) {}
  void side(Float4 ax, Float4 ay, Float4 bx, Float4 by) {
    const Float4 dx = bx - ax, dy = by - ay, px = x_ - ax, py = y_ - ay;
    const Float4 squared = max(dx * dx + dy * dy, Float4(std::numeric_limits<float>::min()));
    const Float4 along = min(max((dx * px + dy * py) * rough_inverse(squared), Float4(0.f)), Float4(1.f));
    const Float4 foot_x = along * dx, foot_y = along * dy;
    const Float4 off = (px - foot_x) * (px - foot_x) + (py - foot_y) * (py - foot_y);
    const Float4 beyond = dx * py < dy * px;
    const Float4 nearer = beyond & (off < distance_);
    distance_ = select(nearer, off, distance_);
    best_x_ = select(nearer, ax + foot_x, best_x_), best_y_ = select(nearer, ay + foot_y, best_y_);
  }
  Float4 x() const { return best_x_; }
  Float4 y() const { return best_y_; }

 private:
  Float4 x_, y_, best_x_, best_y_, distance_ = float_infinity;
};

template <class Spread>
Float4 bound(const BallBound& ball, const FourTriangles& p, const Spread& spread) {
  const Float4 zero = 0.f;
  const Float4 x0 = min(min(p.ax, p.bx), p.cx), x1 = max(max(p.ax, p.bx), p.cx);
  const Float4 y0 = min(min(p.ay, p.by), p.cy), y1 = max(max(p.ay, p.by), p.cy);
  Float4 ex, ey;
  touch_plane(ball, p.slope_x, p.slope_y, ex, ey);
  Nearest nearest(ex, ey);
  nearest.side(p.ax, p.ay, p.bx, p.by);
  nearest.side(p.bx, p.by, p.cx, p.cy);
  nearest.side(p.cx, p.cy, p.ax, p.ay);
  ex = nearest.x(), ey = nearest.y();
  const Float4 plane = p.z + p.slope_x * (ex - p.ax) + p.slope_y * (ey - p.ay);
  const Float4 far_x = max(x0, zero - x1), far_y = max(y0, zero - y1);
  return lesser_bound(ball, spread, p.top, far_x, far_y, ex, ey, plane, p.slope_x, p.slope_y, [&](Float4 gx, Float4 gy) {
    const auto at = [&](Float4 x, Float4 y) { return gx * (x - ex) + gy * (y - ey); };
    return max(max(at(p.ax, p.ay), at(p.bx, p.by)), at(p.cx, p.cy));
  });
}

}  // namespace krepl::drop
