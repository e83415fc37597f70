#pragma once

#include <cstdint>
#include <span>

#include "krepl/point.hpp"

namespace krepl::test {

/// Choices made by bytes, as a fuzzer gives them; all zero where they end.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  bool more() const { return at_ < bytes_.size(); }
  unsigned byte() { return more() ? bytes_[at_++] : 0; }
  unsigned below(unsigned n) { return byte() % n; }
  /// A point of the 16 x 16 grid of whole numbers.
  Point grid() {
    const unsigned b = byte();
    return {double(b & 15), double(b >> 4)};
  }
  /// At least 0, less than 1.
  double unit() { return (byte() * 256.0 + byte()) / 65536; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

}  // namespace krepl::test
