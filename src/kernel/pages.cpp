#include "kernel/pages.hpp"

#include <cstdint>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace krepl::kernel {

void advise_large_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  constexpr std::uintptr_t small = 4096, large = std::uintptr_t{1} << 21;
  const auto address = reinterpret_cast<std::uintptr_t>(memory);
  const std::uintptr_t first = (address + large - 1) / large * large, last = (address + bytes) / large * large;
  if (first >= last) return;
  // The small pages around them, too: neighbours of one kind stay one mapping.
  const std::uintptr_t from = (address + small - 1) / small * small, to = (address + bytes) / small * small;
  madvise(reinterpret_cast<void*>(from), to - from, MADV_HUGEPAGE);
#endif
}

}  // namespace krepl::kernel
