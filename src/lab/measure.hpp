#pragma once

#include <atomic>
#include <functional>
#include <memory>

#include "krepl/context.hpp"
#include "krepl/surface.hpp"
#include "lab/construction.hpp"
#include "terrain/surface_counts.hpp"

namespace krepl::lab {

/// The surface of a construction on one thread. Errors: those of the terrain and of the surface.
Result<Surface> surface_of(const Construction& construction, const Context& context);

/// A limit that can be begun anew for every part of a long computation.
class TimeLimit {
 public:
  /// Starts a thread that watches the clock and the outer context's flag.
  TimeLimit(const Context& outer, double seconds);
  ~TimeLimit();
  /// One thread, and a flag that is set when the time from now on is over, or the outer computation was cancelled.
  Context begin();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The same by the incremental engine, for a second opinion. Error too if there are more than 1000 triangles.
Result<Surface> incremental_surface_of(const Construction& construction, const Context& context);

/// Calls work(index, context of that computation) for all of [0, count) on context.threads threads. Each computation is
/// cancelled after `limit` seconds of the clock (0: never). Results belong in places fixed by the index: below the
/// limit nothing depends on the number of threads. False if the whole was cancelled.
bool run_limited(const Context& context, double limit, std::size_t count,
                 const std::function<void(std::size_t, const Context&)>& work);

}  // namespace krepl::lab
