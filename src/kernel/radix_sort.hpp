#pragma once

#include <cstdint>
#include <vector>

#include "krepl/context.hpp"

namespace krepl::kernel {

/// Sorts 64-bit words by their bits [first_bit, 64), stably, by least-significant-digit radix passes over fixed blocks;
/// the result does not depend on the number of threads. O(n) per 11 bits of key; needs one scratch array of n words.
void radix_sort(std::vector<std::uint64_t>& words, unsigned first_bit, const Context& context);

}  // namespace krepl::kernel
