// Simulations as GeoTIFF and as pictures.
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "ogr/message_capture.hpp"
#include "output/atomic_file.hpp"
#include "output/simulation_file.hpp"

namespace krepl::output {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t least_width = 800;  // of pictures, in pixels

Error failure(const ogr::MessageCapture& messages) {
  return messages.error(ErrorCode::io, "cannot be written", "", "free some space or choose another place");
}

/// By rows from the north.
std::array<std::vector<double>, 3> bands_of(const Simulation& s) {
  std::array<std::vector<double>, 3> bands;
  for (std::size_t row = s.rows(); row-- > 0;)
    for (std::size_t column = 0; column < s.columns(); ++column) {
      const std::size_t d = row * s.columns() + column;
      const bool beside = std::isinf(s.part()[d]);
      bands[0].push_back(s.left()[d]);
      bands[1].push_back(beside ? nan : s.left()[d] - s.part()[d]);
      bands[2].push_back(beside ? nan : double(s.gouge()[d]));
    }
  return bands;
}

Status write_tif(const std::string& path, const Simulation& s, const std::string& crs_text) {
  ogr::MessageCapture messages;
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  if (driver == nullptr) return failure(messages);
  char compress[] = "COMPRESS=DEFLATE", predictor[] = "PREDICTOR=3", big[] = "BIGTIFF=IF_SAFER";
  char* options[] = {compress, predictor, big, nullptr};
  const int columns = int(s.columns()), rows = int(s.rows());
  std::unique_ptr<GDALDataset> file(driver->Create(path.c_str(), columns, rows, 3, GDT_Float64, options));
  if (!file) return failure(messages);
  const Point corner = s.place(0, s.rows() - 1);
  double transform[6] = {corner.x - s.cell() / 2, s.cell(), 0, corner.y + s.cell() / 2, 0, -s.cell()};
  file->SetGeoTransform(transform);
  if (!crs_text.empty()) {
    OGRSpatialReference crs;
    crs.importFromWkt(crs_text.c_str());
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    file->SetSpatialRef(&crs);
  }
  auto bands = bands_of(s);
  const char* const names[] = {"height of the material", "material above the part", "depth of gouges"};
  for (int b = 0; b < 3; ++b) {
    GDALRasterBand* band = file->GetRasterBand(b + 1);
    band->SetDescription(names[b]);
    band->SetNoDataValue(nan);
    if (band->RasterIO(GF_Write, 0, 0, columns, rows, bands[std::size_t(b)].data(), columns, rows, GDT_Float64, 0, 0,
                       nullptr) != CE_None) {
      return failure(messages);
    }
  }
  file->FlushCache(true);
  file.reset();
  return messages.failed() ? Status(failure(messages)) : Status(std::monostate{});
}

struct Colour {
  double r, g, b;
};
Colour mix(Colour a, Colour b, double t) {
  return {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b)};
}
constexpr Colour uncut{0.72, 0.72, 0.72}, finished{0.91, 0.85, 0.70}, some{0.45, 0.72, 0.45}, much{0.25, 0.42, 0.80};
constexpr Colour gouged{0.85, 0.10, 0.10}, dark{0.05, 0.06, 0.12}, paper{1, 1, 1};

/// The relief of what is left.
class Picture {
 public:
  Picture(const Simulation& s, double full) : s_(s), full_(full > 0 ? full : usual_rest()) {
    scale_ = std::max<std::size_t>(1, (least_width + s.columns() - 1) / s.columns());
    lift_ = exaggeration();
  }
  std::size_t width() const { return scale_ * s_.columns(); }
  std::size_t height() const { return scale_ * s_.rows(); }

  std::array<std::vector<std::uint8_t>, 3> bands() const {
    std::array<std::vector<std::uint8_t>, 3> bands;
    for (std::size_t y = 0; y < height(); ++y)
      for (std::size_t x = 0; x < width(); ++x) {
        const Colour colour = light(x / scale_, s_.rows() - 1 - y / scale_);
        for (std::size_t b = 0; b < 3; ++b) {
          const double value = b == 0 ? colour.r : b == 1 ? colour.g : colour.b;
          bands[b].push_back(std::uint8_t(std::lround(255 * std::clamp(value, 0.0, 1.0))));
        }
      }
    return bands;
  }

 private:
  double usual_rest() const {
    std::vector<double> rest;
    for (std::size_t d = 0; d < s_.left().size(); ++d)
      if (!std::isinf(s_.part()[d]) && s_.left()[d] < s_.stock_top()) rest.push_back(s_.left()[d] - s_.part()[d]);
    if (rest.empty()) return 1;
    const auto at = rest.begin() + std::ptrdiff_t(double(rest.size() - 1) * 0.98);
    std::nth_element(rest.begin(), at, rest.end());
    return std::max(*at, 1e-12 * (std::abs(s_.stock_top()) + s_.cell()));
  }
  double slope(std::size_t column, std::size_t row, bool along_x) const {
    const std::size_t at = along_x ? column : row, count = along_x ? s_.columns() : s_.rows();
    const std::size_t low = at > 0 ? at - 1 : at, high = at + 1 < count ? at + 1 : at;
    if (low == high) return 0;
    const auto left = [&](std::size_t k) {
      return s_.left()[along_x ? row * s_.columns() + k : k * s_.columns() + column];
    };
    return (left(high) - left(low)) / (double(high - low) * s_.cell());
  }
  /// Gentle slopes are lit as if they were steeper: the mean one as if it were 0.35.
  double exaggeration() const {
    double sum = 0;
    for (std::size_t row = 0; row < s_.rows(); ++row)
      for (std::size_t column = 0; column < s_.columns(); ++column)
        sum += std::min(1.0, std::hypot(slope(column, row, true), slope(column, row, false)));
    return std::clamp(0.35 * double(s_.left().size()) / std::max(sum, 1e-9), 1.0, 6.0);
  }
  Colour colour(std::size_t d) const {
    if (s_.gouge()[d] > 0) return gouged;
    if (s_.left()[d] >= s_.stock_top()) return uncut;
    if (std::isinf(s_.part()[d])) return finished;
    const double rest = std::clamp((s_.left()[d] - s_.part()[d]) / full_, 0.0, 1.0);
    if (rest < 0.01) return finished;
    return rest < 0.5 ? mix(finished, some, rest / 0.5) : mix(some, much, (rest - 0.5) / 0.5);
  }
  Colour light(std::size_t column, std::size_t row) const {
    const double x = -lift_ * slope(column, row, true), y = -lift_ * slope(column, row, false);
    const double facing = (-0.5 * x + 0.5 * y + std::sqrt(0.5)) / std::sqrt(1 + x * x + y * y);
    const double shade = 0.30 + 0.95 * std::max(0.0, facing);
    const Colour own = colour(row * s_.columns() + column);
    return shade < 1 ? mix(dark, own, shade) : mix(own, paper, std::min(0.7, 2 * (shade - 1)));
  }

  const Simulation& s_;
  double full_, lift_ = 1;
  std::size_t scale_ = 1;
};

Status write_png(const std::string& path, const Picture& picture) {
  ogr::MessageCapture messages;
  GDALDriver* memory = GetGDALDriverManager()->GetDriverByName("MEM");
  GDALDriver* png = GetGDALDriverManager()->GetDriverByName("PNG");
  if (memory == nullptr || png == nullptr) return failure(messages);
  const int width = int(picture.width()), height = int(picture.height());
  std::unique_ptr<GDALDataset> pixels(memory->Create("", width, height, 3, GDT_Byte, nullptr));
  if (!pixels) return failure(messages);
  auto bands = picture.bands();
  for (int b = 0; b < 3; ++b) {
    if (pixels->GetRasterBand(b + 1)->RasterIO(GF_Write, 0, 0, width, height, bands[std::size_t(b)].data(), width,
                                               height, GDT_Byte, 0, 0, nullptr) != CE_None) {
      return failure(messages);
    }
  }
  std::unique_ptr<GDALDataset> copy(png->CreateCopy(path.c_str(), pixels.get(), FALSE, nullptr, nullptr, nullptr));
  if (!copy) return failure(messages);
  copy->FlushCache(true);
  copy.reset();
  return messages.failed() ? Status(failure(messages)) : Status(std::monostate{});
}

}  // namespace

Result<std::string> simulation_format(const std::string& path, const std::string& format) {
  const std::size_t dot = path.rfind('.');
  std::string name = !format.empty() ? format : dot == std::string::npos ? "" : path.substr(dot + 1);
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  if (name == "tiff") name = "tif";
  if (name == "tif" || name == "png") return name;
  return Error{ErrorCode::usage, "'" + name + "' is no format of simulations", "",
               "give a file that ends in .tif or .png"};
}

Status write_simulation(const std::string& path, const Simulation& simulation, const SimulationFileOptions& options) {
  const Result<std::string> format = simulation_format(path, options.format);
  if (!format) return format.error();
  ogr::initialise();
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  Status written = *format == "tif" ? write_tif(file->temporary_path(), simulation, options.crs)
                                    : write_png(file->temporary_path(), Picture(simulation, options.full));
  if (!written) return written;
  return file->commit();
}

}  // namespace krepl::output
