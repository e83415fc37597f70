#pragma once

#include <cmath>
#include <span>

#include "krepl/point.hpp"

namespace krepl::lab {

/// The exponent p of y = c x^p by least squares over the logarithms. NaN unless two different x > 0 with y > 0 are
/// given.
inline double fitted_exponent(std::span<const Point> points) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const Point& p : points) {
    const double u = std::log(p.x), v = std::log(p.y);
    n += 1, x += u, y += v, xx += u * u, xy += u * v;
  }
  const double spread = n * xx - x * x;
  return spread > 1e-12 * n * xx ? (n * xy - x * y) / spread : std::nan("");
}

/// Davenport-Schinzel sequences of order two: lambda_2(n) = 2n - 1.
inline double lambda_2(double n) { return 2 * n - 1; }

}  // namespace krepl::lab
