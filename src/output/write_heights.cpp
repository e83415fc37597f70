// GeoTIFF: heights of the surface at the centres of cells, 64-bit, NaN where the ball touches nothing.
#include <gdal_priv.h>

#include <cmath>
#include <limits>

#include "krepl/drop_cutter.hpp"
#include "ogr/message_capture.hpp"
#include "output/atomic_file.hpp"
#include "output/surface_raster.hpp"
#include "output/surface_writers.hpp"

namespace krepl::output {

namespace {

/// The cells of the input raster, and as many more as the ball reaches beyond its samples.
DropCutter::Raster input_cells(const Terrain& terrain, double radius) {
  const Terrain::Grid& grid = terrain.grid();
  const double more_x = std::floor(radius / grid.cell_x), more_y = std::floor(radius / grid.cell_y);
  DropCutter::Raster raster;
  raster.step_x = grid.cell_x;
  raster.step_y = -grid.cell_y;
  raster.columns = grid.columns + 2 * static_cast<std::size_t>(more_x);
  raster.rows = grid.rows + 2 * static_cast<std::size_t>(more_y);
  raster.first = {grid.first.x - more_x * grid.cell_x, grid.first.y + (double(grid.rows - 1) + more_y) * grid.cell_y};
  return raster;
}

Result<DropCutter::Raster> choose_raster(const Terrain& terrain, double radius, double cell) {
  const SurfaceFrame frame = surface_frame(terrain, radius);
  if (cell <= 0 && terrain.is_grid()) {
    // So large a radius makes a raster of little but the ball itself; then the frame is divided as for a mesh.
    const bool few = radius < 1000 * std::max(terrain.grid().cell_x, terrain.grid().cell_y);
    if (few) return input_cells(terrain, radius);
  }
  if (cell <= 0) cell = std::max(frame.width(), frame.height()) / 1000;
  return covering_raster(frame, cell, cell, "--cell");
}

class HeightFile {
 public:
  HeightFile(const DropCutter::Raster& raster, Point3 origin, const std::string& crs)
      : raster_(raster), origin_(origin), crs_(crs) {}

  Status create(const std::string& path);
  Status put(std::size_t first_row, std::size_t rows, std::span<const DropCutter::Contact> contacts);
  Status close();
  std::size_t without_data() const { return without_data_; }

 private:
  Error failure() const {
    return messages_.error(ErrorCode::io, "cannot be written", "", "free some space or choose another place");
  }

  const DropCutter::Raster& raster_;
  Point3 origin_;
  const std::string& crs_;
  ogr::MessageCapture messages_;
  std::unique_ptr<GDALDataset> dataset_;
  std::vector<double> heights_;
  std::size_t without_data_ = 0;
};

Status HeightFile::create(const std::string& path) {
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  if (driver == nullptr) return failure();
  char compress[] = "COMPRESS=DEFLATE", predictor[] = "PREDICTOR=3", big[] = "BIGTIFF=IF_SAFER";
  char* options[] = {compress, predictor, big, nullptr};
  dataset_.reset(driver->Create(path.c_str(), int(raster_.columns), int(raster_.rows), 1, GDT_Float64, options));
  if (!dataset_) return failure();
  double transform[6] = {raster_.first.x - raster_.step_x / 2 + origin_.x, raster_.step_x, 0,
                         raster_.first.y - raster_.step_y / 2 + origin_.y, 0, raster_.step_y};
  dataset_->SetGeoTransform(transform);
  if (!crs_.empty()) {
    OGRSpatialReference crs;
    crs.importFromWkt(crs_.c_str());
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    dataset_->SetSpatialRef(&crs);
  }
  dataset_->GetRasterBand(1)->SetNoDataValue(std::numeric_limits<double>::quiet_NaN());
  dataset_->GetRasterBand(1)->SetDescription("height of the ball's centre");
  return std::monostate{};
}

Status HeightFile::put(std::size_t first_row, std::size_t rows, std::span<const DropCutter::Contact> contacts) {
  heights_.resize(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    heights_[i] = contacts[i].touches() ? contacts[i].height + origin_.z : std::numeric_limits<double>::quiet_NaN();
    without_data_ += contacts[i].touches() ? 0 : 1;
  }
  messages_.clear();
  const int columns = int(raster_.columns);
  const CPLErr written = dataset_->GetRasterBand(1)->RasterIO(GF_Write, 0, int(first_row), columns, int(rows), heights_.data(),
                                                             columns, int(rows), GDT_Float64, 0, 0, nullptr);
  if (written != CE_None || messages_.failed()) return failure();
  return std::monostate{};
}

Status HeightFile::close() {
  messages_.clear();
  dataset_->FlushCache(true);
  dataset_.reset();
  if (messages_.failed()) return failure();
  return std::monostate{};
}

}  // namespace

SurfaceWriteResult write_heights(const std::string& path, std::shared_ptr<const Terrain> terrain, double radius,
                                 const SurfaceFileOptions& options, const Context& context) {
  ogr::initialise();
  const Result<DropCutter::Raster> raster = choose_raster(*terrain, radius, options.cell);
  if (!raster) return raster.error();
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  const Result<DropCutter> cutter = DropCutter::build(terrain, radius, context);
  if (!cutter) return cutter.error();

  HeightFile heights(*raster, terrain->origin(), options.crs);
  if (Status created = heights.create(file->temporary_path()); !created) return created.error();
  Status written = for_each_strip(*cutter, *raster, 1, context, [&](std::size_t row, std::size_t rows, auto contacts) {
    return heights.put(row, rows, contacts);
  });
  if (!written) return written.error();
  if (Status closed = heights.close(); !closed) return closed.error();
  if (Status committed = file->commit(); !committed) return committed.error();
  SurfaceFileReport report;
  report.columns = raster->columns;
  report.rows = raster->rows;
  report.cells_without_data = heights.without_data();
  return report;
}

}  // namespace krepl::output
