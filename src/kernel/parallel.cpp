#include "kernel/parallel.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <mutex>
#include <thread>
#include <vector>

namespace krepl::kernel {
namespace {

#ifdef __SANITIZE_THREAD__
/// The thread sanitizer cannot see how a oneTBB that was built without it orders the work, and reports every block as a race.
void run_blocks(unsigned threads, std::size_t blocks, const std::function<void(std::size_t)>& run) {
  std::atomic<std::size_t> next{0};
  std::vector<std::thread> pool(threads == 0 ? std::thread::hardware_concurrency() : threads);
  for (std::thread& thread : pool) {
    thread = std::thread([&] {
      for (std::size_t b; (b = next++) < blocks;) run(b);
    });
  }
  for (std::thread& thread : pool) thread.join();
}
#else
void run_blocks(unsigned threads, std::size_t blocks, const std::function<void(std::size_t)>& run) {
  // More threads than cores are what was asked for, not an oversight that oneTBB has to warn about.
  const std::size_t most = std::max<std::size_t>(threads, std::size_t(tbb::info::default_concurrency()));
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, most);
  tbb::task_arena arena(threads == 0 ? tbb::task_arena::automatic : int(threads));
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, blocks, run); });
}
#endif

}  // namespace

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
    run_blocks(context.threads, blocks, run);
  }
  return !context.cancelled();
}

}  // namespace krepl::kernel
