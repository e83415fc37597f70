#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "krepl/point.hpp"

namespace krepl::kernel {

/// A sum of doubles kept exactly: components that do not overlap, the last one that is not zero tells the sign.
template <std::size_t most>
class ExactSum {
 public:
  void add(double b) {
    for (std::size_t i = 0; i < count_; ++i) {
      const double sum = term_[i] + b, part = sum - term_[i];
      term_[i] = (term_[i] - (sum - part)) + (b - part);  // what rounding took away
      b = sum;
    }
    term_[count_++] = b;
  }
  void add_product(double a, double b) {
    const double product = a * b;
    add(std::fma(a, b, -product));
    add(product);
  }
  int sign() const {
    for (std::size_t i = count_; i-- > 0;)
      if (term_[i] != 0) return term_[i] > 0 ? 1 : -1;
    return 0;
  }

 private:
  std::array<double, most> term_;
  std::size_t count_ = 0;
};

inline int exact_orientation(Point a, Point b, Point c) {
  const double largest =
      std::max({std::abs(a.x), std::abs(a.y), std::abs(b.x), std::abs(b.y), std::abs(c.x), std::abs(c.y)});
  if (largest == 0) return 0;
  // So that no product over- or underflows; coordinates may differ by a factor of 2^900.
  const int exponent = 480 - std::ilogb(largest);
  for (Point* p : {&a, &b, &c}) p->x = std::scalbn(p->x, exponent), p->y = std::scalbn(p->y, exponent);
  ExactSum<12> sum;
  sum.add_product(a.x, b.y);
  sum.add_product(-a.y, b.x);
  sum.add_product(b.x, c.y);
  sum.add_product(-b.y, c.x);
  sum.add_product(c.x, a.y);
  sum.add_product(-c.y, a.x);
  return sum.sign();
}

/// 1 if a, b, c turn left, -1 if they turn right, 0 if they are collinear; exact. [Shewchuk 1997, section 4.1: the
/// filter.]
inline int orientation(Point a, Point b, Point c) {
  const double left_factors[] = {a.x - c.x, b.y - c.y}, right_factors[] = {a.y - c.y, b.x - c.x};
  const double left = left_factors[0] * left_factors[1], right = right_factors[0] * right_factors[1];
  const double determinant = left - right, bound = 0x1.8000000000004p-52 * (std::abs(left) + std::abs(right));
  if (std::abs(determinant) > bound && bound > 0x1p-900) return determinant > 0 ? 1 : -1;
  // A difference is zero only if it is so exactly, which decides most of what is axis-parallel.
  if ((left_factors[0] == 0 || left_factors[1] == 0) && (right_factors[0] == 0 || right_factors[1] == 0)) return 0;
  return exact_orientation(a, b, c);
}

/// True if a, b and c lie on a line, or coincide; exact.
inline bool collinear(Point3 a, Point3 b, Point3 c) {
  return orientation({a.x, a.y}, {b.x, b.y}, {c.x, c.y}) == 0 && orientation({a.y, a.z}, {b.y, b.z}, {c.y, c.z}) == 0 &&
         orientation({a.z, a.x}, {b.z, b.x}, {c.z, c.x}) == 0;
}

}  // namespace krepl::kernel
