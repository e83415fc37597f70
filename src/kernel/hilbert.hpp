#pragma once

#include <array>
#include <cstdint>

namespace krepl::kernel {

/// Position along the Hilbert curve through a grid of 2^16 x 2^16 cells; neighbours along the curve are neighbours in the
/// plane. Four bits of each coordinate a step, by a table that is made from the one-bit rule at compile time.
class HilbertCurve {
 public:
  static std::uint32_t index(std::uint32_t x, std::uint32_t y) {
    std::uint32_t state = 0;
    std::uint32_t code = 0;
    for (int shift = 12; shift >= 0; shift -= 4) {
      const std::uint32_t cell = ((x >> shift) & 15u) << 4 | ((y >> shift) & 15u);
      const Step step = table[state][cell];
      code = code << 8 | step.code;
      state = step.state;
    }
    return code;
  }

 private:
  struct Step {
    std::uint8_t code;
    std::uint8_t state;
  };
  // State bits: 1 = x and y exchanged, 2 = both complemented. The quadrants are visited (0,0) (0,1) (1,1) (1,0).
  static constexpr Step four_bits(std::uint32_t state, std::uint32_t cell) {
    std::uint32_t code = 0;
    for (int bit = 3; bit >= 0; --bit) {
      std::uint32_t x = (cell >> (4 + bit)) & 1u;
      std::uint32_t y = (cell >> bit) & 1u;
      if (state & 2u) x ^= 1u, y ^= 1u;
      if (state & 1u) {
        const std::uint32_t t = x;
        x = y;
        y = t;
      }
      const std::uint32_t quadrant = (3u * x) ^ y;
      code = code << 2 | quadrant;
      // The first quadrant is traversed transposed, the last one transposed and reversed.
      if (quadrant == 0) state ^= 1u;
      if (quadrant == 3) state ^= 3u;
    }
    return {std::uint8_t(code), std::uint8_t(state)};
  }
  static constexpr auto make_table() {
    std::array<std::array<Step, 256>, 4> t{};
    for (std::uint32_t s = 0; s < 4; ++s)
      for (std::uint32_t c = 0; c < 256; ++c) t[s][c] = four_bits(s, c);
    return t;
  }
  static const std::array<std::array<Step, 256>, 4> table;
};

inline constexpr std::array<std::array<HilbertCurve::Step, 256>, 4> HilbertCurve::table = HilbertCurve::make_table();

}  // namespace krepl::kernel
