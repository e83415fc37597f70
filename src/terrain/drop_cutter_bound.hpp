#pragma once

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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
  friend Float4 operator>=(Float4 a, Float4 b) { return _mm_cmpge_ps(a.v, b.v); }
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
  friend Float4 operator>=(Float4 a, Float4 b) { return each([&](auto k) { return a.v[k] >= b.v[k] ? 1.f : 0.f; }); }
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

inline constexpr float float_infinity = std::numeric_limits<float>::infinity();

/// Rounded to single precision, up or down.
inline float up(double x) {
  const float f = float(x);
  return double(f) < x ? std::nextafter(f, float_infinity) : f;
}
inline float down(double x) { return -up(-x); }

/// What the bounds need to know of the ball. All lengths in bounds are in units of Scale::unit.
struct BallBound {
  float radius, squared, squared_up;
  explicit BallBound(double r) : radius(float(r)), squared(radius * radius), squared_up(squared * (1 + 0x1p-20f)) {}
};

/// Slopes beyond it are not used in bounds, so that the rounding of coordinates costs little height.
inline constexpr float steepest = 8;

/// Four parts of the terrain as the bounds see them. A part lies over a rectangle [x0, x1] x [y0, y1], in coordinates
/// relative to the place, below the height `top` and below the plane  level + slope . (q - middle of the rectangle).
struct FourParts {
  Float4 top, level, slope_x, slope_y;
  Float4 x0, x1, y0, y1;
};

/// What rounding inside bound() may cost over a rectangle of the given sides; to be added to `level`.
inline double bound_rounding(double width, double height, double slope_x, double slope_y) {
  return 0x1p-18 * (width * (1 + std::abs(slope_x)) + height * (1 + std::abs(slope_y)));
}

/// Upper bounds of (height of a ball that touches the part) - R; -infinity for parts farther than R from the place.
/// Subtracting R keeps the digits where R is much larger than the terrain.
///
/// For a point q of a part, with e = q - place and rho = sqrt(R^2 - e^2), the ball that touches q is at z(q) + rho. Hence:
///   by the top     top + rho at the point of the rectangle nearest to the place;
///   by the plane   f(q) = plane(q) + rho(q) is concave, so its tangent at any q0 bounds it over the rectangle. The q0 taken
///                  is where the ball would touch the whole plane, e = R slope / sqrt(1 + slope^2), moved into the rectangle:
///                  there the tangent rises little, or out of the rectangle.
inline Float4 bound(const BallBound& ball, const FourParts& p) {
  const Float4 zero = 0.f, one = 1.f, half = 0.5f, shrink = 1 - 0x1p-20f, radius = ball.radius;
  const Float4 near_x = max(max(p.x0, zero - p.x1), zero), near_y = max(max(p.y0, zero - p.y1), zero);
  const Float4 d2 = near_x * near_x + near_y * near_y;
  const Float4 s = Float4(ball.squared_up) - d2;
  const Float4 within = s >= zero;
  const Float4 by_top = p.top - shrink * d2 / (radius + sqrt(max(s, zero)));

  const Float4 pull = radius * rough_inverse_root(one + p.slope_x * p.slope_x + p.slope_y * p.slope_y);
  const Float4 ex = min(max(p.slope_x * pull, p.x0), p.x1), ey = min(max(p.slope_y * pull, p.y0), p.y1);
  const Float4 e2 = ex * ex + ey * ey;
  const Float4 least = 0x1p-4f * ball.squared;  // below it the tangent is too steep for single precision
  const Float4 rho2 = Float4(ball.squared) - e2;
  const Float4 rho = sqrt(max(rho2, least));
  const Float4 inverse = one / (rho * (radius + rho));
  const Float4 tilt = (radius + rho) * inverse;  // 1 / rho
  const Float4 gx = p.slope_x - ex * tilt, gy = p.slope_y - ey * tilt;
  const Float4 plane = p.level + p.slope_x * (ex - half * (p.x0 + p.x1)) + p.slope_y * (ey - half * (p.y0 + p.y1));
  const Float4 rise = max(gx * (p.x1 - ex), gx * (p.x0 - ex)) + max(gy * (p.y1 - ey), gy * (p.y0 - ey));
  const Float4 by_plane = plane - shrink * e2 * (rho * inverse) + rise;

  const Float4 both = min(by_top, select(rho2 >= least, by_plane, by_top));
  return select(within, both, Float4(-float_infinity));
}

}  // namespace krepl::drop
