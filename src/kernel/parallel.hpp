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

/// Memory for `count` elements whose pages are already there: the system clears a page when it is first written to,
/// which for large arrays takes longer than filling them, and all threads share that here. The vector's size does not
/// change.
template <class T>
void reserve_pages(const Context& context, std::vector<T>& vector, std::size_t count) {
  vector.reserve(count);
  constexpr std::size_t page = 4096;
  std::byte* const memory = reinterpret_cast<std::byte*>(vector.data());
  const std::size_t used = vector.size() * sizeof(T), bytes = count * sizeof(T);
  if (bytes < used + (std::size_t{1} << 20)) return;
  Context quiet;
  quiet.threads = context.threads;
  parallel_blocks(quiet, bytes - used, 256 * page, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; i += page) memory[used + i] = std::byte{0};
  });
}

/// vector.resize(count, value), the pages of new memory cleared as by reserve_pages.
template <class T>
void resize_pages(const Context& context, std::vector<T>& vector, std::size_t count, const T& value = {}) {
  reserve_pages(context, vector, count);
  vector.resize(count, value);
}

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
