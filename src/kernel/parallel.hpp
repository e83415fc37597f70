#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>
#include <vector>

#include "krepl/context.hpp"

namespace krepl::kernel {

/// Runs work(first, last) over [0, count) cut into blocks of fixed size, on context.threads threads. The cut does not
/// depend on the number of threads, so results kept per block are the same for any. Returns false if cancelled.
bool parallel_blocks(const Context& context, std::size_t count, std::size_t block,
                     const std::function<void(std::size_t first, std::size_t last)>& work);

/// Adds up finished work from many threads and reports it as a fraction.
class Progress {
 public:
  Progress(const Context& context, std::size_t total);
  void add(std::size_t done);

 private:
  const Context& context_;
  std::size_t total_;
  std::atomic<std::size_t> done_{0};
  std::mutex mutex_;
};

}  // namespace krepl::kernel
