#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "kernel/parallel.hpp"
#include "verify/plane.hpp"
#include "verify/zone_verifier.hpp"

namespace krepl::verify {

/// The largest deviation and how many broke the limit.
struct Tally {
  std::uint64_t tested = 0, violations = 0;
  Real worst = 0;
  Vec where;
  void add(Real deviation, Real limit, Vec place) {
    ++tested;
    if (!(deviation <= limit)) ++violations;  // NaN breaks it too
    if (deviation > worst) worst = deviation, where = place;
  }
  void add(const Tally& t) {
    tested += t.tested, violations += t.violations;
    if (t.worst > worst) worst = t.worst, where = t.where;
  }
  Check check(std::string name, Real limit) const {
    Check c;
    c.name = std::move(name);
    c.tested = tested, c.violations = violations;
    c.worst = double(worst), c.limit = double(limit), c.where = {double(where.x), double(where.y)};
    return c;
  }
};

/// Adds up f(i, sum) over [0, count) on all threads; the result does not depend on their number.
template <class Sum = Tally, class F>
Sum tally_all(const Context& context, std::size_t count, F&& f) {
  constexpr std::size_t block = 256;
  std::vector<Sum> tallies(count / block + 1);
  kernel::parallel_blocks(context, count, block, [&](std::size_t first, std::size_t last) {
    // A block boundary is a multiple of `block`, so each slot has one writer.
    for (std::size_t i = first; i < last; ++i) f(i, tallies[i / block]);
  });
  Sum all;
  for (const Sum& t : tallies) all.add(t);
  return all;
}

/// A sequence of random numbers of its own for each index (splitmix64), the same on every machine.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t index)
      : state_(seed * 0x9E3779B97F4A7C15u ^ (index + 1) * 0xD1B54A32D192ED03u) {
    next();
  }
  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  /// Uniform in [0,1).
  Real unit() { return Real(next() >> 11) * 0x1p-53L; }
  std::size_t below(std::size_t n) { return std::size_t(next() % n); }

 private:
  std::uint64_t state_;
};

}  // namespace krepl::verify
