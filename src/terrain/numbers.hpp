#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

#include "kernel/double_double.hpp"
#include "kernel/quad.hpp"
#include "krepl/surface.hpp"

// What the engine computes with: everything from patches to cells exists in double, and in twice the digits for the few
// small cells in which double cannot tell what shows.
namespace krepl::terrain {

using kernel::absolute;
using kernel::DoubleDouble;
using kernel::square_root;

/// For what costs too much in large cells, of which few need it.
template <class Real>
inline constexpr bool is_fine = std::is_same_v<Real, DoubleDouble>;

inline bool is_finite(double x) { return std::isfinite(x); }
inline bool is_finite(DoubleDouble x) { return std::isfinite(x.high); }

template <class Real>
Real norm(Real x, Real y) {
  return square_root(x * x + y * y);
}

/// Of the height above the rim where gradients are taken, relative to R: they are steep, but finite.
constexpr double least_square = 1e-12;

/// Slopes from which on heights in double, and tests on gradients, tell little.
constexpr double steep = 16;

/// Lengths relative to S, the scale of the accuracy contract, and to R.
template <class Real>
struct Precision;
template <>
struct Precision<double> {
  static constexpr double tolerance = 0x1p-40;          ///< lengths and heights that differ by less are not told apart
  static constexpr double smallest_cell = 0x1p-36;
  static constexpr double noise = 0x1p-49;              ///< heights that differ by less count as equal
  static constexpr double smallest_stretch = 0x1p-50;   ///< of a line, to be cut further
  static constexpr double rounding = 1e-15;             ///< of a sum of a few products
  static constexpr double corner = 1e-13;               ///< of directions
};
template <>
struct Precision<DoubleDouble> {
  static constexpr double tolerance = 0x1p-50;
  static constexpr double smallest_cell = 0x1p-46;
  static constexpr double noise = 0x1p-92;
  static constexpr double smallest_stretch = 0x1p-54;
  static constexpr double rounding = 1e-30;
  static constexpr double corner = 1e-28;
};

template <class Real>
struct PlanePoint {
  Real x, y;
};
template <class Real>
using PointOf = std::conditional_t<std::is_same_v<Real, double>, Point, PlanePoint<Real>>;

template <class Real>
struct GradientOf {
  Real x, y;
};
template <class Real>
Real size(GradientOf<Real> g) {
  return norm(g.x, g.y);
}
/// The multiple of g that is nearest to f.
template <class Real>
Real multiple_along(GradientOf<Real> f, GradientOf<Real> g) {
  return (f.x * g.x + f.y * g.y) / (g.x * g.x + g.y * g.y);
}

/// An axis-parallel rectangle; of no width or height where it is a stretch of a line.
template <class Real>
struct BoxOf {
  using Point = PointOf<Real>;
  Point low, high;
  Point middle() const { return {(low.x + high.x) / 2, (low.y + high.y) / 2}; }
  Real half_x() const { return (high.x - low.x) / 2; }
  Real half_y() const { return (high.y - low.y) / 2; }
  Real larger_side() const { return std::max(high.x - low.x, high.y - low.y); }
  /// Counter-clockwise from the lowest.
  std::array<Point, 4> corners() const { return {low, {high.x, low.y}, high, {low.x, high.y}}; }
  bool contains(Point p) const { return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y; }
  bool contains(const BoxOf& b) const { return contains(b.low) && contains(b.high); }
  BoxOf intersection(const BoxOf& b) const {
    return {{std::max(low.x, b.low.x), std::max(low.y, b.low.y)}, {std::min(high.x, b.high.x), std::min(high.y, b.high.y)}};
  }
  bool is_empty() const { return !(low.x <= high.x && low.y <= high.y); }
  bool meets(const BoxOf& b) const {  // without branches
    return bool((b.high.x >= low.x) & (b.low.x <= high.x) & (b.high.y >= low.y) & (b.low.y <= high.y));
  }
};
using Box = BoxOf<double>;

template <class Real>
struct RangeOf {
  Real low, high;
  bool excludes_zero() const { return low > 0 || high < 0; }
  friend RangeOf operator-(RangeOf a, RangeOf b) { return {a.low - b.high, a.high - b.low}; }
  friend RangeOf operator+(RangeOf a, RangeOf b) { return {a.low + b.low, a.high + b.high}; }
  friend RangeOf operator*(RangeOf a, RangeOf b) {
    const Real p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
    return {std::min({p, q, r, s}), std::max({p, q, r, s})};
  }
};
template <class Real>
struct GradientRangeOf {
  RangeOf<Real> x, y;
};

}  // namespace krepl::terrain
