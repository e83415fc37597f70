// Rasters in another coordinate system. GDAL finds the new raster's place and cell size; the heights are interpolated
// here, because its warper's weights bend planes and do not even keep a constant to the last bit, so that lakes would
// lose their flatness.
#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_alg.h>

#include <cmath>
#include <limits>

#include "input/projection.hpp"
#include "input/raster_pixels.hpp"
#include "ogr/message_capture.hpp"
#include "ogr/spatial_reference.hpp"

namespace krepl::input {

namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// Places all along the border, which stand for the raster when a projection is chosen and tried.
Parts border(const RasterPixels& pixels) {
  constexpr int steps = 32;
  Parts parts;
  for (int i = 0; i < steps; ++i) {
    const double u = double(i) / steps, c = double(pixels.columns), r = double(pixels.rows);
    for (const Point p :
         {pixels.place(u * c, 0), pixels.place(c, u * r), pixels.place(c - u * c, r), pixels.place(0, r - u * r)})
      parts.points.push_back(p);
  }
  parts.begin.push_back(parts.points.size());
  parts.feature.push_back(0);
  parts.kind.push_back(Parts::Kind::line);
  return parts;
}

/// North up, with square pixels about as large as the given ones.
Result<RasterPixels> new_frame(const RasterPixels& pixels, const OGRSpatialReference& from,
                               const OGRSpatialReference& to) {
  ogr::MessageCapture messages;
  const Error failed{ErrorCode::input, "cannot be resampled to " + ogr::crs_name(to), "",
                     "choose another --to-crs or cut the raster"};
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("MEM");
  const std::unique_ptr<GDALDataset> frame(
      driver->Create("", int(pixels.columns), int(pixels.rows), 0, GDT_Float64, nullptr));
  if (!frame) return failed;
  frame->SetGeoTransform(const_cast<double*>(pixels.transform.data()));
  CPLStringList options;
  options.SetNameValue("SRC_SRS", ogr::crs_definition(from).c_str());
  options.SetNameValue("DST_SRS", ogr::crs_definition(to).c_str());
  GDALDatasetH handle = GDALDataset::ToHandle(frame.get());
  const std::unique_ptr<void, void (*)(void*)> transformer(
      GDALCreateGenImgProjTransformer2(handle, nullptr, options.List()), GDALDestroyGenImgProjTransformer);
  RasterPixels result;
  int columns = 0, rows = 0;
  if (!transformer || GDALSuggestedWarpOutput(handle, GDALGenImgProjTransform, transformer.get(),
                                              result.transform.data(), &columns, &rows) != CE_None) {
    return messages.error(failed.code, failed.what, "", failed.remedy);
  }
  result.columns = std::size_t(columns), result.rows = std::size_t(rows);
  result.crs = to;
  return result;
}

/// Bilinear interpolation between the samples of a raster.
class Interpolation {
 public:
  explicit Interpolation(const RasterPixels& pixels, bool in_degrees) : p_(pixels) {
    const auto& t = p_.transform;
    const double determinant = t[1] * t[5] - t[2] * t[4];
    inverse_ = {t[5] / determinant, -t[2] / determinant, -t[4] / determinant, t[1] / determinant};
    turn_ = in_degrees ? 360 : 0;
  }

  /// Missing outside the outermost samples, and where a sample that counts is missing.
  double at(double x, double y) const {
    if (!std::isfinite(x) || !std::isfinite(y)) return missing;
    for (const double shift : {0.0, turn_, -turn_}) {  // longitudes may be counted from another meridian
      const double dx = x + shift - p_.transform[0], dy = y - p_.transform[3];
      const double column = inverse_[0] * dx + inverse_[1] * dy - 0.5, row = inverse_[2] * dx + inverse_[3] * dy - 0.5;
      if (column >= 0 && row >= 0 && column <= double(p_.columns - 1) && row <= double(p_.rows - 1))
        return between(column, row);
    }
    return missing;
  }

 private:
  static double mix(double a, double b, double t) { return t == 0 ? a : a + t * (b - a); }  // exact where a = b
  double sample(std::size_t column, std::size_t row) const {
    return p_.heights[std::min(row, p_.rows - 1) * p_.columns + std::min(column, p_.columns - 1)];
  }
  double between(double column, double row) const {
    const auto c = std::size_t(column), r = std::size_t(row);
    const double u = column - double(c), v = row - double(r);
    const double low = mix(sample(c, r), sample(c + 1, r), u);
    return v == 0 ? low : mix(low, mix(sample(c, r + 1), sample(c + 1, r + 1), u), v);
  }

  const RasterPixels& p_;
  std::array<double, 4> inverse_{};
  double turn_ = 0;
};

/// Fills the heights of `result` from those of `pixels`, row by row.
Status interpolate(const RasterPixels& pixels, RasterPixels& result, OGRCoordinateTransformation& back,
                   const Context& context) {
  const Interpolation heights(pixels, pixels.crs->IsGeographic() != 0);
  result.heights.resize(result.columns * result.rows);
  std::vector<double> x(result.columns), y(result.columns);
  std::vector<int> done(result.columns);
  ogr::MessageCapture ignored;  // places out of reach are missing samples
  for (std::size_t row = 0; row < result.rows; ++row) {
    if (context.cancelled()) return Error{ErrorCode::cancelled, "interrupted while resampling", "", ""};
    if (context.progress) context.progress(double(row) / double(result.rows));
    for (std::size_t c = 0; c < result.columns; ++c) {
      const Point p = result.place(double(c) + 0.5, double(row) + 0.5);
      x[c] = p.x, y[c] = p.y;
    }
    back.Transform(int(result.columns), x.data(), y.data(), nullptr, done.data());
    for (std::size_t c = 0; c < result.columns; ++c)
      result.heights[row * result.columns + c] = done[c] != 0 ? heights.at(x[c], y[c]) : missing;
  }
  return std::monostate{};
}

}  // namespace

Status project_pixels(RasterPixels& pixels, const std::string& to_crs, std::vector<std::string>& notes,
                      const Context& context) {
  Parts parts = border(pixels);
  std::vector<std::string> ignored;
  const auto plane =
      project(parts, {pixels.crs, to_crs, [](std::int64_t) { return "border of the raster"; }}, ignored, context);
  if (!plane) {
    Error error = plane.error();
    if (error.where.starts_with("border"))
      error.remedy = "choose another --to-crs or cut the raster: gdal_translate -projwin";
    return error;
  }
  const bool north_up = pixels.transform[2] == 0 && pixels.transform[4] == 0;
  if (to_crs.empty() || (north_up && pixels.crs->IsSame(&**plane) != 0)) return std::monostate{};
  OGRSpatialReference from = *pixels.crs;
  from.StripVertical();  // heights stay what they are
  Result<RasterPixels> result = new_frame(pixels, from, **plane);
  if (!result) return result.error();
  if (Status size = check_size(*result); !size) return size.error();
  const std::unique_ptr<OGRCoordinateTransformation> back(OGRCreateCoordinateTransformation(&**plane, &from));
  if (!back)
    return Error{ErrorCode::input, "cannot be resampled to " + ogr::crs_name(**plane), "", "choose another --to-crs"};
  if (Status filled = interpolate(pixels, *result, *back, context); !filled) return filled;
  notes.push_back(fmt::format("note: resampled (bilinear) to {}, cells {:.6g} x {:.6g}", ogr::crs_name(**plane),
                              result->transform[1], -result->transform[5]));
  pixels = std::move(*result);
  return std::monostate{};
}

}  // namespace krepl::input
