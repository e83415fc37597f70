#pragma once

#include <cmath>
#include <cstdint>
#include <random>

namespace krepl::lab {

/// Random numbers that are the same on every machine: the distributions of the standard library are not.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  /// Of one of many cases: neighbouring numbers give unrelated sequences.
  Random(std::uint64_t seed, std::uint64_t number) : engine_(mixed(seed + mixed(number))) {}

  double between(double low, double high) { return low + (high - low) * (double(engine_() >> 11) * 0x1p-53); }
  /// Evenly spread over its logarithm.
  double scaled(double low, double high) {
    const double x = between(0, 1);
    return low * std::pow(high / low, x);
  }
  std::size_t below(std::size_t count) { return std::size_t(engine_() % count); }
  bool one_in(std::size_t count) { return below(count) == 0; }

 private:
  static std::uint64_t mixed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
  }
  std::mt19937_64 engine_;
};

}  // namespace krepl::lab
