#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

namespace krepl::kernel {

/// Work that many threads spend, and a limit. What exceeds the limit at the end has done so whatever the order of work, so
/// threads do not change what is given up.
class Budget {
 public:
  /// 0: no limit. Below 2^20 nothing is given up: it would take longer to start anew.
  explicit Budget(std::uint64_t most) {
    constexpr std::uint64_t few = std::uint64_t{1} << 20;
    if (most > 0) most_ = std::max(few, most);
  }
  void spend(std::uint64_t work) { spent_.fetch_add(work, std::memory_order_relaxed); }
  bool is_exceeded() const { return spent_.load(std::memory_order_relaxed) > most_; }

 private:
  std::uint64_t most_ = ~std::uint64_t{0};
  std::atomic<std::uint64_t> spent_{0};
};

}  // namespace krepl::kernel
