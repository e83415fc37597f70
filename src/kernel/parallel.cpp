#include "kernel/parallel.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <mutex>

namespace krepl::kernel {

Progress::Progress(const Context& context, std::size_t total) : context_(context), total_(total ? total : 1) {}

void Progress::add(std::size_t done) {
  const std::size_t now = done_.fetch_add(done, std::memory_order_relaxed) + done;
  if (!context_.progress) return;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (lock) context_.progress(double(now) / double(total_));
}

bool parallel_blocks(const Context& context, std::size_t count, std::size_t block,
                     const std::function<void(std::size_t, std::size_t)>& work) {
  const std::size_t blocks = (count + block - 1) / block;
  const auto run = [&](std::size_t b) {
    if (!context.cancelled()) work(b * block, std::min(count, (b + 1) * block));
  };
  if (context.threads == 1 || blocks <= 1) {
    for (std::size_t b = 0; b < blocks; ++b) run(b);
  } else {
    tbb::task_arena arena(context.threads == 0 ? tbb::task_arena::automatic : int(context.threads));
    arena.execute([&] { tbb::parallel_for(std::size_t{0}, blocks, run); });
  }
  return !context.cancelled();
}

}  // namespace krepl::kernel
