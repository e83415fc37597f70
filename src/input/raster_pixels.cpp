#include "input/raster_pixels.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "input/ascii_grid_check.hpp"
#include "ogr/message_capture.hpp"
#include "ogr/spatial_reference.hpp"

namespace krepl::input {

namespace {

using Dataset = std::unique_ptr<GDALDataset>;

constexpr std::size_t most_samples = std::size_t{1} << 29;  // what Terrain takes

Dataset try_open(const std::string& path) {
  return Dataset(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
}

/// The only file in an archive: some drivers want its name, and do not find it themselves.
std::optional<std::string> only_member(const std::string& vsi_path) {
  if (!vsi_path.starts_with("/vsizip/") && !vsi_path.starts_with("/vsitar/")) return std::nullopt;
  const CPLStringList names(VSIReadDir(vsi_path.c_str()));
  if (names.size() != 1) return std::nullopt;
  return vsi_path + "/" + names[0];
}

/// Several rasters in one file have names of their own.
Error no_band(GDALDataset& dataset) {
  const CPLStringList list(dataset.GetMetadata("SUBDATASETS"), FALSE);
  std::string names;
  for (int i = 1;; ++i) {
    const char* name = list.FetchNameValue(fmt::format("SUBDATASET_{}_NAME", i).c_str());
    if (name == nullptr) break;
    names += (names.empty() ? "" : ", ") + std::string(name);
  }
  if (names.empty()) return {ErrorCode::input, "has no raster band", "", "give a raster of heights"};
  return {ErrorCode::input, "holds several rasters", "", "give one of these as the file: " + names};
}

Result<GDALRasterBand*> choose_band(GDALDataset& dataset, int wanted, std::vector<std::string>& notes) {
  const int count = dataset.GetRasterCount();
  if (count == 0) return no_band(dataset);
  if (wanted < 0 || wanted > count) {
    return Error{ErrorCode::usage, fmt::format("there is no band {}", wanted), "",
                 count == 1 ? "there is one band" : fmt::format("the bands are 1 to {}", count)};
  }
  GDALRasterBand* band = dataset.GetRasterBand(wanted == 0 ? 1 : wanted);
  if (GDALDataTypeIsComplex(band->GetRasterDataType()) != 0)
    return Error{ErrorCode::input, "holds complex numbers", "", "give a raster of heights"};
  if (wanted == 0 && count > 1)
    notes.push_back(fmt::format("note: band 1 of {} is taken as heights; see --band", count));
  return band;
}

void find_transform(GDALDataset& dataset, RasterPixels& pixels, std::vector<std::string>& notes) {
  if (dataset.GetGeoTransform(pixels.transform.data()) == CE_None) return;
  pixels.transform = {0, 1, 0, double(pixels.rows), 0, -1};
  notes.emplace_back("note: the file does not say where the raster lies; its pixels are taken as 1 x 1, from (0, 0)");
}

Result<std::optional<OGRSpatialReference>> find_crs(GDALDataset& dataset, const std::string& given) {
  std::optional<OGRSpatialReference> crs;
  if (!given.empty()) {
    Result<OGRSpatialReference> parsed = ogr::parse_crs(given);
    if (!parsed) return parsed.error();
    crs = *parsed;
  } else if (const OGRSpatialReference* reference = dataset.GetSpatialRef(); reference != nullptr) {
    crs = *reference;
    crs->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  }
  return crs;
}

/// What a stored number means: the band's own scale and offset, then the user's.
struct Scale {
  double factor = 1, offset = 0, z_scale = 1;
  double height(double stored) const { return (stored * factor + offset) * z_scale; }
};

Scale scale_of(GDALRasterBand& band, double z_scale, std::vector<std::string>& notes) {
  const Scale scale{band.GetScale(), band.GetOffset(), z_scale};
  if (scale.factor != 1 || scale.offset != 0) {
    notes.push_back(fmt::format("note: the band's scale {} and offset {} are applied", scale.factor, scale.offset));
  }
  return scale;
}

void note_unit(GDALRasterBand& band, const TerrainRequest& request, const RasterPixels& pixels,
               std::vector<std::string>& notes) {
  const std::string unit = band.GetUnitType();
  if (unit.empty() || request.z_scale != 1 || !pixels.crs) return;
  if (unit == "m" || unit == "metre" || unit == "meter" || unit == "metres" || unit == "meters") return;
  notes.push_back("note: heights are in '" + unit + "'; --z-scale brings them to the unit of x and y");
}

Error infinite_height(const RasterPixels& pixels, std::size_t column, std::size_t row) {
  const Point at = pixels.place(double(column) + 0.5, double(row) + 0.5);
  return {ErrorCode::input, "a height is infinite", fmt::format("column {}, row {} ({} {})", column, row, at.x, at.y),
          "correct it, or mark it as no data: gdal_translate -a_nodata"};
}

class RowReader {
 public:
  RowReader(GDALRasterBand& band, const Scale& scale, RasterPixels& pixels)
      : band_(band), scale_(scale), pixels_(pixels), masked_((band.GetMaskFlags() & GMF_ALL_VALID) == 0) {}

  Status read(std::size_t first, std::size_t count) {
    ogr::MessageCapture messages;
    const auto failed = [&] {
      return messages.error(ErrorCode::io, "cannot be read to its end", fmt::format("row {}", first),
                            "the file seems to be damaged: get it again");
    };
    const int row = int(first), columns = int(pixels_.columns), rows = int(count);
    double* heights = pixels_.heights.data() + first * pixels_.columns;
    if (band_.RasterIO(GF_Read, 0, row, columns, rows, heights, columns, rows, GDT_Float64, 0, 0, nullptr) != CE_None ||
        messages.failed()) {
      return failed();
    }
    if (masked_) {
      mask_.resize(pixels_.columns * count);
      if (band_.GetMaskBand()->RasterIO(GF_Read, 0, row, columns, rows, mask_.data(), columns, rows, GDT_Byte, 0, 0,
                                        nullptr) != CE_None) {
        return failed();
      }
    }
    for (std::size_t i = 0; i < pixels_.columns * count; ++i) {
      heights[i] = masked_ && mask_[i] == 0 ? std::numeric_limits<double>::quiet_NaN() : scale_.height(heights[i]);
      if (std::isinf(heights[i])) return infinite_height(pixels_, i % pixels_.columns, first + i / pixels_.columns);
    }
    return std::monostate{};
  }

 private:
  GDALRasterBand& band_;
  const Scale& scale_;
  RasterPixels& pixels_;
  bool masked_;
  std::vector<GByte> mask_;
};

Status read_rows(GDALRasterBand& band, const Scale& scale, RasterPixels& pixels, const Context& context) {
  pixels.heights.resize(pixels.columns * pixels.rows);
  RowReader reader(band, scale, pixels);
  const std::size_t portion = std::max<std::size_t>(1, (std::size_t{1} << 18) / pixels.columns);
  for (std::size_t row = 0; row < pixels.rows; row += portion) {
    if (context.cancelled()) return Error{ErrorCode::cancelled, "interrupted while reading", "", ""};
    if (context.progress) context.progress(double(row) / double(pixels.rows));
    if (Status read = reader.read(row, std::min(portion, pixels.rows - row)); !read) return read;
  }
  return std::monostate{};
}

}  // namespace

Status check_size(const RasterPixels& pixels) {
  if (pixels.columns <= most_samples / pixels.rows) return std::monostate{};
  return Error{ErrorCode::input, "has more than 2^29 samples", fmt::format("{} x {}", pixels.columns, pixels.rows),
               "cut it (gdal_translate -projwin) or make it coarser"};
}

Result<Dataset> open_raster(const std::string& vsi_path) {
  ogr::initialise();
  ogr::MessageCapture messages;
  if (Dataset dataset = try_open(vsi_path)) return dataset;
  if (const auto member = only_member(vsi_path)) {
    ogr::MessageCapture again;
    if (Dataset dataset = try_open(*member)) return dataset;
  }
  return messages.error(ErrorCode::input, "is neither a raster that can be read nor a mesh", "",
                        "give a GDAL raster, or STL, OBJ, PLY or OFF");
}

Result<RasterPixels> read_pixels(GDALDataset& dataset, const TerrainRequest& request, std::vector<std::string>& notes,
                                 const Context& context) {
  const Result<GDALRasterBand*> band = choose_band(dataset, request.band, notes);
  if (!band) return band.error();
  RasterPixels pixels;
  pixels.columns = std::size_t(dataset.GetRasterXSize()), pixels.rows = std::size_t(dataset.GetRasterYSize());
  if (Status size = check_size(pixels); !size) return size.error();
  ogr::MessageCapture ignored;
  find_transform(dataset, pixels, notes);
  const auto crs = find_crs(dataset, request.crs);
  if (!crs) return crs.error();
  pixels.crs = *crs;
  if (const std::string driver = dataset.GetDriverName(); driver == "AAIGrid" || driver == "GRASSASCIIGrid") {
    const Status whole = check_ascii_grid(dataset.GetDescription(), pixels.columns * pixels.rows, context);
    if (!whole) return whole.error();
  }
  const Scale scale = scale_of(**band, request.z_scale, notes);
  note_unit(**band, request, pixels, notes);
  if (Status read = read_rows(**band, scale, pixels, context); !read) return read.error();
  return pixels;
}

}  // namespace krepl::input
