// OpenVDB: the distance field of the terrain's triangles in a band of R about them; the level R of it is the boundary
// of the sum. Its upper side is read off column by column afterwards, which is not timed.
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/global_control.h>

#include <cmath>
#include <thread>

#include "operations.hpp"

namespace bench {
namespace {

class OpenVdb : public Operation {
 public:
  explicit OpenVdb(const Task& task)
      : task_(task),
        threads_(tbb::global_control::max_allowed_parallelism,
                 task.threads > 0 ? task.threads : std::thread::hardware_concurrency()) {
    openvdb::initialize();
    const krepl::Terrain::Grid& grid = task.samples.grid;
    const auto index = [&](std::size_t i, std::size_t j) { return openvdb::Int32(j * grid.columns + i); };
    const auto missing = [&](openvdb::Int32 v) { return std::isnan(task.samples.heights[std::size_t(v)]); };
    for (std::size_t j = 0; j < grid.rows; ++j)
      for (std::size_t i = 0; i < grid.columns; ++i)
        points_.emplace_back(double(i) * grid.cell_x, double(j) * grid.cell_y,
                             std::isnan(task.samples.at(i, j)) ? 0.0 : task.samples.at(i, j));
    for (std::size_t j = 0; j + 1 < grid.rows; ++j)
      for (std::size_t i = 0; i + 1 < grid.columns; ++i)
        for (const openvdb::Vec3I t : {openvdb::Vec3I(index(i, j), index(i + 1, j), index(i + 1, j + 1)),
                                       openvdb::Vec3I(index(i, j), index(i + 1, j + 1), index(i, j + 1))})
          if (!missing(t[0]) && !missing(t[1]) && !missing(t[2])) triangles_.push_back(t);
  }

  bool run() override {
    distance_.reset();
    const auto transform = openvdb::math::Transform::createLinearTransform(task_.step);
    const float band = float(task_.radius / task_.step + 2);
    distance_ =
        openvdb::tools::meshToUnsignedDistanceField<openvdb::FloatGrid>(*transform, points_, triangles_, {}, band);
    return distance_ != nullptr;
  }

  std::string facts() const override {
    const krepl::Terrain::Grid& grid = task_.samples.grid;
    const double width = double(grid.columns - 1) * grid.cell_x, height = double(grid.rows - 1) * grid.cell_y;
    const krepl::Point3 low = task_.terrain->lowest();
    const krepl::DropCutter::Raster raster{{low.x, low.y},
                                           task_.step,
                                           task_.step,
                                           std::size_t(width / task_.step) + 1,
                                           std::size_t(height / task_.step) + 1};
    return ", \"points\": " + std::to_string(raster.columns * raster.rows) +
           ", \"voxels\": " + std::to_string(distance_->activeVoxelCount()) +
           height_errors(task_, raster, heights(raster)).facts();
  }

 private:
  /// The uppermost place of each column of voxels where the distance passes R, between two of them in proportion.
  std::vector<double> heights(const krepl::DropCutter::Raster& raster) const {
    std::vector<double> best(raster.columns * raster.rows, NAN);
    const auto accessor = distance_->getConstAccessor();
    for (auto voxel = distance_->cbeginValueOn(); voxel; ++voxel) {
      const openvdb::Coord at = voxel.getCoord();
      if (at.x() < 0 || at.y() < 0 || std::size_t(at.x()) >= raster.columns || std::size_t(at.y()) >= raster.rows)
        continue;
      const double here = *voxel, above = accessor.getValue(at.offsetBy(0, 0, 1));
      if (!(here <= task_.radius && above > task_.radius)) continue;
      const double z = (double(at.z()) + (task_.radius - here) / (above - here)) * task_.step;
      double& known = best[std::size_t(at.y()) * raster.columns + std::size_t(at.x())];
      if (!(known >= z)) known = z;
    }
    return best;
  }

  Task task_;
  tbb::global_control threads_;
  std::vector<openvdb::Vec3s> points_;
  std::vector<openvdb::Vec3I> triangles_;
  openvdb::FloatGrid::Ptr distance_;
};

}  // namespace

std::unique_ptr<Operation> make_openvdb(const Task& task) { return std::make_unique<OpenVdb>(task); }

}  // namespace bench
