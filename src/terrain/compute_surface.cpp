#include <algorithm>
#include <condition_variable>
#include <map>
#include <mutex>

#include "kernel/parallel.hpp"
#include "model/radius_check.hpp"
#include "terrain/assembly.hpp"

namespace krepl {
namespace {

Error uncertified(const Terrain& terrain, Point at) {
  const Point3 o = terrain.origin();
  return Error{ErrorCode::computation, "the surface could not be certified",
               "near x " + shown(at.x + o.x) + ", y " + shown(at.y + o.y), "please report this input"};
}

/// Puts tiles together in their order, whatever order they come in, while others are being computed.
class TileQueue {
 public:
  TileQueue(const std::shared_ptr<const Terrain>& terrain, double radius, const terrain::Tiling& tiling)
      : terrain_(*terrain), assembly_(terrain, radius, tiling) {}

  /// The next tile to compute. Waits while too many are kept for one that takes long. False if computing on is of no use.
  bool next(std::size_t& tile) {
    std::unique_lock lock(mutex_);
    tile = started_++;
    // The tile that all wait for has been started by a thread that does not wait.
    changed_.wait(lock, [&] { return error_ || tile < added_ + most_kept; });
    return !error_;
  }

  void put(std::size_t number, terrain::Tile tile) {
    const std::lock_guard lock(mutex_);
    kept_.emplace(number, std::move(tile));
    while (!error_ && !kept_.empty() && kept_.begin()->first == added_) {
      terrain::Tile first = std::move(kept_.extract(kept_.begin()).mapped());
      if (first.failed_at) error_ = uncertified(terrain_, *first.failed_at);
      else error_ = assembly_.add(std::move(first));
      ++added_;
    }
    changed_.notify_all();
  }

  void stop(Error error) {
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = std::move(error);
    changed_.notify_all();
  }

  Result<Surface> finish() {
    if (error_) return *error_;
    return assembly_.finish();
  }

 private:
  /// Tiles that wait for an earlier one: enough that threads rarely wait for each other, few as compared to the surface.
  static constexpr std::size_t most_kept = 32;

  const Terrain& terrain_;
  SurfaceAssembly assembly_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::size_t, terrain::Tile> kept_;
  std::size_t started_ = 0, added_ = 0;
  std::optional<Error> error_;
};

}  // namespace

Result<Surface> compute_surface(std::shared_ptr<const Terrain> terrain, const SurfaceOptions& options, const Context& context) {
  const double radius = options.radius;
  if (auto error = refuse_radius(*terrain, radius, 0x1p-30)) return *error;
  const double scale = std::max(radius, terrain->extent());
  const Error cancelled{ErrorCode::cancelled, "cancelled", "", ""};
  const terrain::Tiling tiling = terrain::tiling_for(*terrain, radius);
  TileQueue queue(terrain, radius, tiling);
  Context quiet = context;
  quiet.progress = nullptr;
  kernel::Progress progress(context, tiling.count());
  const bool done = kernel::parallel_blocks(context, tiling.count(), 1, [&](std::size_t, std::size_t) {
    thread_local terrain::TileWorker worker;
    std::size_t t = 0;
    if (!queue.next(t)) return;
    const auto column = terrain::Index(t % tiling.columns), row = terrain::Index(t / tiling.columns);
    terrain::Tile tile = worker.compute(*terrain, tiling, column, row, radius, scale, quiet);
    if (context.cancelled()) {  // the tile may be half done
      queue.stop(cancelled);
      return;
    }
    queue.put(t, std::move(tile));
    progress.add(1);
  });
  if (!done) return cancelled;
  return queue.finish();
}

}  // namespace krepl
