#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "kernel/quad.hpp"

namespace krepl::voronoi {

/// 320 bits: the last rung of the ladder, for what the move of vertices, 2^-72 of the extent, decides only in its third
/// power.
using wide = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<320, boost::multiprecision::digit_base_2, void, std::int32_t>,
    boost::multiprecision::et_off>;

}  // namespace krepl::voronoi

namespace krepl::kernel {

inline voronoi::wide square_root(const voronoi::wide& x) { return x > 0 ? voronoi::wide(sqrt(x)) : voronoi::wide(0); }
template <>
inline constexpr double unit_roundoff<voronoi::wide> = 0x1p-320;

}  // namespace krepl::kernel
