#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <functional>
#include <memory>
#include <mutex>
#include <new>
#include <span>
#include <type_traits>
#include <vector>

#include "kernel/parallel.hpp"

namespace krepl::kernel {

/// Asks the system to back memory that was not written to yet with pages of megabytes instead of kilobytes: it is asked for a
/// page five hundred times less often, and addresses are translated from fewer entries. Together they were a third of the time
/// of large zones and Voronoi diagrams. A hint: without such pages, and for less than one of them, nothing happens.
void advise_large_pages(void* memory, std::size_t bytes);

/// vector.reserve(count), in large pages.
template <class T>
void reserve_large(std::vector<T>& vector, std::size_t count) {
  if (count <= vector.capacity()) return;
  vector.reserve(count);
  advise_large_pages(vector.data() + vector.size(), (count - vector.size()) * sizeof(T));
}

/// reserve_large, and the pages are there already: the system clears a page when it is first written to, which for large
/// arrays takes longer than filling them, and all threads share that here. The vector's size does not change.
template <class T>
void reserve_pages(const Context& context, std::vector<T>& vector, std::size_t count) {
  reserve_large(vector, count);
  constexpr std::size_t page = 4096;
  std::byte* const memory = reinterpret_cast<std::byte*>(vector.data());
  const std::size_t used = vector.size() * sizeof(T), bytes = count * sizeof(T);
  if (bytes < used + (std::size_t{1} << 20)) return;
  Context quiet;
  quiet.threads = context.threads;
  parallel_blocks(quiet, bytes - used, 512 * page, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; i += page) memory[used + i] = std::byte{0};
  });
}

/// vector.resize(count, value), the pages of new memory cleared as by reserve_pages.
template <class T>
void resize_pages(const Context& context, std::vector<T>& vector, std::size_t count, const T& value = {}) {
  reserve_pages(context, vector, count);
  vector.resize(count, value);
}

/// Keeps copies of many arrays in few pieces of memory of large pages. What was kept stays where it is until it is released.
template <class T>
class Store {
 public:
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

  /// From any thread.
  std::span<const T> keep(std::span<const T> array) {
    if (array.empty()) return {};
    T* const place = take(array.size());
    std::memcpy(static_cast<void*>(place), array.data(), array.size_bytes());
    return {place, array.size()};
  }
  /// Each array once, after the last one was kept; a piece is given back with the last of its arrays.
  void release(std::span<const T> array) {
    const auto piece = std::ranges::find_if(pieces_, [&](const Piece& p) {
      return !std::less<const T*>()(array.data(), p.memory.get()) && std::less<const T*>()(array.data(), p.memory.get() + p.count);
    });
    if (piece != pieces_.end() && --piece->arrays == 0) pieces_.erase(piece);
  }

 private:
  // In bytes: from small ones, as many a store keeps little, to what glibc always takes from the system and gives back
  // to it at once.
  static constexpr std::size_t first_piece = std::size_t{1} << 14, last_piece = std::size_t{1} << 25, growth = 4;
  static constexpr std::size_t large_page = std::size_t{1} << 21;

  struct Free {
    std::align_val_t alignment;
    void operator()(T* memory) const { ::operator delete(memory, alignment); }
  };
  struct Piece {
    std::unique_ptr<T, Free> memory;
    std::size_t count, used, arrays;
  };

  T* take(std::size_t count) {
    const std::lock_guard lock(mutex_);
    if (pieces_.empty() || pieces_.back().count - pieces_.back().used < count) {
      const std::size_t bytes = std::max(count * sizeof(T), next_piece_);
      next_piece_ = std::min(growth * bytes, last_piece);
      const std::align_val_t alignment{bytes < large_page ? alignof(T) : large_page};
      pieces_.push_back({{static_cast<T*>(::operator new(bytes, alignment)), Free{alignment}}, bytes / sizeof(T), 0, 0});
      advise_large_pages(pieces_.back().memory.get(), bytes);
    }
    Piece& piece = pieces_.back();
    T* const place = piece.memory.get() + piece.used;
    piece.used += count, ++piece.arrays;
    return place;
  }

  std::mutex mutex_;
  std::vector<Piece> pieces_;
  std::size_t next_piece_ = first_piece;
};

}  // namespace krepl::kernel
