#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "kernel/quad.hpp"

namespace krepl::kernel {

/// 320 bits: the last rung of the ladder, for what a move of vertices by 2^-72 of the extent decides only in its second
/// or third power.
using wide = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<320, boost::multiprecision::digit_base_2, void, std::int32_t>,
    boost::multiprecision::et_off>;

inline wide square_root(const wide& x) { return x > 0 ? wide(sqrt(x)) : wide(0); }
template <>
inline constexpr double unit_roundoff<wide> = 0x1p-320;

/// All bits of a number in quadruple precision: three doubles hold them.
inline wide widened(quad x) {
  const double high = double(x), middle = double(x - high), low = double(x - high - middle);
  return wide(high) + wide(middle) + wide(low);
}

}  // namespace krepl::kernel
