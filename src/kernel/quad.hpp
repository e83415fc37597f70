#pragma once

#include <cmath>

namespace krepl::kernel {

/// Quadruple precision (113 bits) as compiler and run-time library provide it; the upper rung of the predicates' ladder.
using quad = __float128;

inline double square_root(double x) { return std::sqrt(x); }

/// Newton's iteration from the double root: 53 -> 106 -> 212 bits, cut at 113. Zero for x <= 0.
inline quad square_root(quad x) {
  if (!(x > 0)) return 0;
  // The argument is brought near 1 so that the double root neither under- nor overflows.
  int exponent = 0;
  const double head = double(x);
  if (head == 0 || !std::isfinite(head)) return 0;
  std::frexp(head, &exponent);
  exponent &= ~1;
  const quad scaled = x * quad(std::ldexp(1.0, -exponent / 2)) * quad(std::ldexp(1.0, -exponent / 2));
  quad root = std::sqrt(double(scaled));
  root = (root + scaled / root) / 2;
  root = (root + scaled / root) / 2;
  return root * quad(std::ldexp(1.0, exponent / 2));
}

template <class Real>
Real absolute(Real x) {
  return x < 0 ? -x : x;
}

/// Half the distance from 1 to the next number.
template <class Real>
inline constexpr double unit_roundoff = 0x1p-53;
template <>
inline constexpr double unit_roundoff<quad> = 0x1p-113;

}  // namespace krepl::kernel
