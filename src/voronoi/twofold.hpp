#pragma once

#include <cmath>

#include "kernel/double_double.hpp"
#include "kernel/quad.hpp"

namespace krepl::voronoi {

/// Pairs of doubles, about 106 bits, that calculate with infinities and zeros as doubles do: the rung below quadruple
/// precision, which is several times as slow in software.
struct Twofold {
  kernel::DoubleDouble pair;

  Twofold() = default;
  Twofold(double x) : pair(x) {}
  Twofold(kernel::DoubleDouble x) : pair(x) {}
  explicit operator double() const { return pair.high; }  // the pair is normalised

  friend Twofold operator-(Twofold a) { return -a.pair; }
  friend Twofold operator+(Twofold a, Twofold b) { return checked(a.pair + b.pair, a.pair.high + b.pair.high); }
  friend Twofold operator-(Twofold a, Twofold b) { return a + -b; }
  friend Twofold operator*(Twofold a, Twofold b) { return checked(a.pair * b.pair, a.pair.high * b.pair.high); }
  friend Twofold operator/(Twofold a, Twofold b) { return checked(a.pair / b.pair, a.pair.high / b.pair.high); }
  Twofold& operator+=(Twofold b) { return *this = *this + b; }

  friend bool operator<(Twofold a, Twofold b) { return a.pair < b.pair; }
  friend bool operator>(Twofold a, Twofold b) { return b < a; }
  friend bool operator<=(Twofold a, Twofold b) { return a.pair <= b.pair; }
  friend bool operator>=(Twofold a, Twofold b) { return b <= a; }
  friend bool operator==(Twofold a, Twofold b) { return a.pair == b.pair; }

 private:
  static Twofold checked(kernel::DoubleDouble x, double rough) { return std::isfinite(x.high) ? x : rough; }
};

}  // namespace krepl::voronoi

namespace krepl::kernel {

inline voronoi::Twofold square_root(voronoi::Twofold x) {
  return std::isfinite(x.pair.high) ? voronoi::Twofold(square_root(x.pair)) : voronoi::Twofold(std::sqrt(x.pair.high));
}
template <>
inline constexpr double unit_roundoff<voronoi::Twofold> = 0x1p-104;

}  // namespace krepl::kernel
