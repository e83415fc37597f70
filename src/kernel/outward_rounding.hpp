#pragma once

#include <cmath>
#include <limits>

namespace krepl::kernel {

/// The nearest number of single precision that is not above x, or not below it: boxes in single precision rounded outwards.
inline float float_below(double x) {
  const float f = float(x);
  return double(f) > x ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}
inline float float_above(double x) {
  const float f = float(x);
  return double(f) < x ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}

}  // namespace krepl::kernel
