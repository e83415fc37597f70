#include "kernel/radix_sort.hpp"

#include <array>

#include "kernel/parallel.hpp"

namespace krepl::kernel {
namespace {

constexpr unsigned digit_bits = 11;
constexpr std::size_t digits = std::size_t{1} << digit_bits;
using Histogram = std::array<std::uint32_t, digits>;

}  // namespace

void radix_sort(std::vector<std::uint64_t>& words, unsigned first_bit, const Context& context) {
  const std::size_t n = words.size();
  const std::size_t block = std::max<std::size_t>(std::size_t{1} << 16, n / 32 + 1);
  const std::size_t blocks = (n + block - 1) / block;
  Context quiet;
  quiet.threads = context.threads;
  std::vector<std::uint64_t> scratch(n);
  std::vector<Histogram> histogram(blocks);
  for (unsigned shift = first_bit; shift < 64; shift += digit_bits) {
    const auto digit = [shift](std::uint64_t w) { return (w >> shift) & (digits - 1); };
    parallel_blocks(quiet, n, block, [&](std::size_t first, std::size_t last) {
      Histogram& count = histogram[first / block];
      count.fill(0);
      for (std::size_t i = first; i < last; ++i) ++count[digit(words[i])];
    });
    std::uint32_t total = 0;
    for (std::size_t d = 0; d < digits; ++d) {
      for (std::size_t b = 0; b < blocks; ++b) {
        const std::uint32_t count = histogram[b][d];
        histogram[b][d] = total;
        total += count;
      }
    }
    parallel_blocks(quiet, n, block, [&](std::size_t first, std::size_t last) {
      Histogram& place = histogram[first / block];
      for (std::size_t i = first; i < last; ++i) scratch[place[digit(words[i])]++] = words[i];
    });
    words.swap(scratch);
  }
}

}  // namespace krepl::kernel
