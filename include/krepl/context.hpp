#pragma once

#include <atomic>
#include <functional>

namespace krepl {

/// How a computation runs, as opposed to what it computes: no member of Context changes a result by a single bit.
struct Context {
  /// Number of threads, 1 or more; 0 (the default) means all that the machine has.
  unsigned threads = 0;
  /// Called now and then with the fraction done, in [0,1], never from two threads at once. May be empty.
  std::function<void(double)> progress;
  /// When it points to a flag that becomes true, the computation ends within a fraction of a second with
  /// ErrorCode::cancelled. May be null.
  const std::atomic<bool>* cancel = nullptr;

  bool cancelled() const { return cancel != nullptr && cancel->load(std::memory_order_relaxed); }
};

}  // namespace krepl
