#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "krepl/drop_cutter.hpp"
#include "terrains.hpp"

namespace bench {

struct Task {
  const Samples& samples;
  std::shared_ptr<const krepl::Terrain> terrain;
  double radius;
  double step;       ///< of peers: distance of their samples, in the unit of the coordinates
  unsigned threads;  ///< 0: all

  krepl::Context context() const { return {.threads = threads, .progress = {}, .cancel = nullptr}; }
};

/// One way to do it; only run() is timed.
class Operation {
 public:
  virtual ~Operation() = default;
  /// False if it failed.
  virtual bool run() = 0;
  /// Members of a JSON object about the last run, which begin with a comma.
  virtual std::string facts() const = 0;
};

std::unique_ptr<Operation> make_surface(const Task& task);
/// `way`: build (the hierarchy), cells (a raster, a place a cell), quarters (a raster in the middle, four places a cell
/// side), list (random places in bulk), single (random places one by one).
std::unique_ptr<Operation> make_drop(const Task& task, const std::string& way);
std::unique_ptr<Operation> make_dilation(const Task& task);
#ifdef KREPL_BENCH_OPENVDB
std::unique_ptr<Operation> make_openvdb(const Task& task);
#endif

/// What is wrong with heights found by others at the places of a raster: NaN where nothing is touched. Places where the
/// ball touches nothing, or where there is no height, are left out.
struct HeightErrors {
  double largest = 0, mean = 0;
  std::size_t places = 0;
  std::string facts() const;
};
HeightErrors height_errors(const Task& task, const krepl::DropCutter::Raster& raster,
                           const std::vector<double>& heights);

}  // namespace bench
