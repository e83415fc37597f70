#include "lab/measure.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "kernel/parallel.hpp"
#include "krepl/incremental.hpp"

namespace krepl::lab {

using Clock = std::chrono::steady_clock;

Result<Surface> surface_of(const Construction& construction, const Context& context) {
  auto terrain = terrain_of(construction);
  if (!terrain) return terrain.error();
  return compute_surface(*terrain, {construction.radius}, context);
}

Result<Surface> incremental_surface_of(const Construction& construction, const Context& context) {
  auto terrain = terrain_of(construction);
  if (!terrain) return terrain.error();
  IncrementalOptions options;
  options.radius = construction.radius;
  return compute_surface_incremental(*terrain, options, context);
}

struct TimeLimit::State {
  State(const Context& context, double limit) : outer(context), seconds(limit) {}

  const Context& outer;
  const double seconds;
  std::atomic<bool> stop = false;
  std::mutex mutex;  // of all below
  std::condition_variable ended;
  bool over = false;
  Clock::time_point start = Clock::now();
  std::thread watch;

  void look() {
    using namespace std::chrono_literals;
    std::unique_lock lock(mutex);
    while (!ended.wait_for(lock, 20ms, [this] { return over; })) {
      const std::chrono::duration<double> passed = Clock::now() - start;
      if (outer.cancelled() || (seconds > 0 && passed.count() > seconds)) stop = true;
    }
  }
};

TimeLimit::TimeLimit(const Context& outer, double seconds) : state_(new State(outer, seconds)) {
  state_->watch = std::thread([state = state_.get()] { state->look(); });
}

TimeLimit::~TimeLimit() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->over = true;
  }
  state_->ended.notify_one();
  state_->watch.join();
}

Context TimeLimit::begin() {
  const std::lock_guard lock(state_->mutex);
  state_->start = Clock::now();
  state_->stop = state_->outer.cancelled();
  Context context;
  context.threads = 1;
  context.cancel = &state_->stop;
  return context;
}

bool run_limited(const Context& context, double limit, std::size_t count,
                 const std::function<void(std::size_t, const Context&)>& work) {
  kernel::Progress progress(context, count);
  return kernel::parallel_blocks(context, count, 1, [&](std::size_t first, std::size_t last) {
    TimeLimit time(context, limit);
    for (std::size_t i = first; i < last; ++i) work(i, time.begin());
    progress.add(last - first);
  });
}

}  // namespace krepl::lab
