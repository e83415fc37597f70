#include <algorithm>
#include <cmath>

#include "kernel/parallel.hpp"
#include "terrain/assembly.hpp"

namespace krepl {
namespace {

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", x);
  return text;
}

void add(SurfaceCounters& sum, const SurfaceCounters& c) {
  sum.patches += c.patches;
  sum.cells += c.cells;
  sum.leaves += c.leaves;
  sum.smallest_cells += c.smallest_cells;
  sum.lines += c.lines;
  sum.height_evaluations += c.height_evaluations;
}

}  // namespace

Result<Surface> compute_surface(std::shared_ptr<const Terrain> terrain, const SurfaceOptions& options, const Context& context) {
  const double radius = options.radius;
  if (!std::isfinite(radius) || radius <= 0) {
    return Error{ErrorCode::usage, "the radius is " + number(radius), "", "give a positive, finite number"};
  }
  const double scale = std::max(radius, terrain->extent());
  if (scale > 1e100 || radius < 1e-100) {
    return Error{ErrorCode::input, "coordinates or radius are beyond 1e100, or the radius is below 1e-100", "",
                 "scale the input"};
  }
  if (radius < 0x1p-30 * scale) {
    return Error{ErrorCode::usage, "the radius " + number(radius) + " is too fine for an extent of " + number(scale), "",
                 "use at least " + number(0x1p-30 * scale)};
  }
  const Error cancelled{ErrorCode::cancelled, "cancelled", "", ""};
  const terrain::Tiling tiling = terrain::tiling_for(*terrain, radius);
  std::vector<terrain::Tile> tiles(tiling.count());
  Context quiet = context;
  quiet.progress = nullptr;
  kernel::Progress progress(context, tiles.size());
  const bool done = kernel::parallel_blocks(context, tiles.size(), 1, [&](std::size_t t, std::size_t) {
    thread_local terrain::TileWorker worker;
    tiles[t] = worker.compute(*terrain, tiling, terrain::Index(t % tiling.columns), terrain::Index(t / tiling.columns), radius,
                              scale, quiet);
    progress.add(1);
  });
  if (!done) return cancelled;
  SurfaceCounters counters;
  for (const terrain::Tile& tile : tiles) {
    if (tile.failed_at) {
      const Point3 o = terrain->origin();
      return Error{ErrorCode::computation, "the surface could not be certified",
                   "near x " + number(tile.failed_at->x + o.x) + ", y " + number(tile.failed_at->y + o.y),
                   "please report this input"};
    }
    add(counters, tile.counters);
  }
  return SurfaceAssembly::assemble(std::move(terrain), radius, tiling, std::move(tiles), counters);
}

}  // namespace krepl
