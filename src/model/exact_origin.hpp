#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace krepl {

/// The middle of [low, high] rounded to a multiple of a power of two near the half width, so that subtracting it from
/// any double in between is exact; 0 where the interval is near 0 and a shift would gain nothing and lose exactness.
///
/// Why it is exact: with m the middle and h the half width, the origin is within h/2 of m, so for m > 3h every double
/// of the interval is within a factor of two of it (Sterbenz).
inline double exact_origin(double low, double high) {
  const double middle = low / 2 + high / 2;
  const double half = high / 2 - low / 2;
  const double largest = std::max(std::abs(low), std::abs(high));
  if (std::abs(middle) <= 3 * half || largest == 0) return 0;
  const double finest = std::nextafter(largest, std::numeric_limits<double>::infinity()) - largest;
  const double unit = std::ldexp(1.0, std::ilogb(std::max(half, finest)));
  return std::rint(middle / unit) * unit;
}

}  // namespace krepl
