#pragma once

#include <cmath>

namespace krepl::kernel {

/// About 106 bits as an unevaluated sum of two doubles (Dekker 1971), with the exponents of double. The upper rung of the
/// ladder: ties are ordinary on lattices, and this is ten times as fast as quadruple precision in software.
/// Needs round-to-nearest and no contraction to fused multiply-add. Infinities can be compared, not computed with.
struct DoubleDouble {
  double high = 0, low = 0;

  DoubleDouble() = default;
  DoubleDouble(double value) : high(value) {}
  DoubleDouble(double h, double l) : high(h), low(l) {}
  explicit operator double() const { return high + low; }

  /// a + b, exactly.
  [[gnu::always_inline]] static DoubleDouble sum(double a, double b) {
    const double s = a + b, bb = s - a;
    return {s, (a - (s - bb)) + (b - bb)};
  }
  /// a + b, exactly, where |a| >= |b| or a == 0.
  [[gnu::always_inline]] static DoubleDouble quick_sum(double a, double b) {
    const double s = a + b;
    return {s, b - (s - a)};
  }
  /// a * b, exactly, barring under- and overflow.
  [[gnu::always_inline]] static DoubleDouble product(double a, double b) {
    constexpr double splitter = 0x1p27 + 1;
    const double ca = splitter * a, ah = ca - (ca - a), al = a - ah;
    const double cb = splitter * b, bh = cb - (cb - b), bl = b - bh;
    const double p = a * b;
    return {p, ((ah * bh - p) + ah * bl + al * bh) + al * bl};
  }

  [[gnu::always_inline]] friend DoubleDouble operator-(DoubleDouble a) { return {-a.high, -a.low}; }
  [[gnu::always_inline]] friend DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
    DoubleDouble s = sum(a.high, b.high);
    const DoubleDouble t = sum(a.low, b.low);
    s = quick_sum(s.high, s.low + t.high);
    return quick_sum(s.high, s.low + t.low);
  }
  [[gnu::always_inline]] friend DoubleDouble operator-(DoubleDouble a, DoubleDouble b) { return a + -b; }
  [[gnu::always_inline]] friend DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
    const DoubleDouble p = product(a.high, b.high);
    return quick_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
  }
  friend DoubleDouble operator/(DoubleDouble a, DoubleDouble b) {
    const double q1 = a.high / b.high;
    DoubleDouble rest = a - q1 * b;
    const double q2 = rest.high / b.high;
    rest = rest - q2 * b;
    const DoubleDouble q = quick_sum(q1, q2);
    return q + DoubleDouble(rest.high / b.high);
  }
  DoubleDouble& operator+=(DoubleDouble b) { return *this = *this + b; }
  DoubleDouble& operator*=(DoubleDouble b) { return *this = *this * b; }
  DoubleDouble& operator/=(DoubleDouble b) { return *this = *this / b; }
  friend bool operator<(DoubleDouble a, DoubleDouble b) { return a.high < b.high || (a.high == b.high && a.low < b.low); }
  friend bool operator>(DoubleDouble a, DoubleDouble b) { return b < a; }
  friend bool operator<=(DoubleDouble a, DoubleDouble b) { return a.high < b.high || (a.high == b.high && a.low <= b.low); }
  friend bool operator>=(DoubleDouble a, DoubleDouble b) { return b <= a; }
  friend bool operator==(DoubleDouble a, DoubleDouble b) { return a.high == b.high && a.low == b.low; }
};

/// Zero for x <= 0. One step of Newton's iteration from the double root gives all digits.
inline DoubleDouble square_root(DoubleDouble x) {
  if (!(x.high > 0)) return 0.0;
  const double r = std::sqrt(x.high);
  const DoubleDouble rest = x - DoubleDouble::product(r, r);
  return DoubleDouble::quick_sum(r, rest.high / (2 * r));
}

}  // namespace krepl::kernel
