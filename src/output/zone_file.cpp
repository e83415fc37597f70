#include "output/zone_file.hpp"

#include <gdal_priv.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <sstream>

#include "ogr/message_capture.hpp"
#include "output/zone_writers.hpp"

namespace krepl::output {

namespace {

using Kind = ZoneFormat::Kind;

struct KnownFormat {
  const char* name;
  Kind kind;
  const char* driver;
};
// Also the extensions.
constexpr KnownFormat known_formats[] = {
    {"gpkg", Kind::ogr, "GPKG"},      {"fgb", Kind::ogr, "FlatGeobuf"}, {"wkt", Kind::wkt, ""},
    {"wkb", Kind::wkb, ""},           {"geojson", Kind::geojson, ""},   {"json", Kind::geojson, ""},
    {"shp", Kind::ogr, "ESRI Shapefile"}, {"svg", Kind::svg, ""},       {"dxf", Kind::dxf, ""},
};
constexpr const char* format_list = "gpkg, fgb, wkt, wkb, geojson, shp, svg, dxf or the name of a GDAL vector driver";

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::optional<ZoneFormat> known_format(const std::string& name) {
  for (const KnownFormat& known : known_formats) {
    if (name == known.name) return ZoneFormat{known.kind, known.name, known.driver};
  }
  return std::nullopt;
}

bool can_create_vectors(GDALDriver& driver) {
  return driver.GetMetadataItem(GDAL_DCAP_VECTOR) != nullptr && driver.GetMetadataItem(GDAL_DCAP_CREATE) != nullptr;
}

std::optional<ZoneFormat> driver_by_extension(const std::string& extension) {
  GDALDriverManager& manager = *GetGDALDriverManager();
  for (int i = 0; i < manager.GetDriverCount(); ++i) {
    GDALDriver& driver = *manager.GetDriver(i);
    const char* extensions = driver.GetMetadataItem(GDAL_DMD_EXTENSIONS);
    if (extensions == nullptr || !can_create_vectors(driver)) continue;
    std::istringstream words(extensions);
    for (std::string word; words >> word;) {
      if (lower(word) == extension) return ZoneFormat{Kind::ogr, driver.GetDescription(), driver.GetDescription()};
    }
  }
  return std::nullopt;
}

std::optional<ZoneFormat> driver_by_name(const std::string& name) {
  // Formats that krepl writes itself, with arcs or with every failure noticed, whatever name they are asked by.
  for (auto [driver, own] : {std::pair{"geojson", "geojson"}, {"svg", "svg"}, {"dxf", "dxf"}}) {
    if (lower(name) == driver) return known_format(own);
  }
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(name.c_str());
  if (driver == nullptr || !can_create_vectors(*driver)) return std::nullopt;
  return ZoneFormat{Kind::ogr, driver->GetDescription(), driver->GetDescription()};
}

WriteResult write_as(const std::string& path, std::span<const Zone> zones, const ZoneFormat& format,
                     const ZoneFileOptions& options, const Context& context) {
  switch (format.kind) {
    case Kind::wkt: return write_wkt(path, zones, options, context);
    case Kind::wkb: return write_wkb(path, zones, options, context);
    case Kind::geojson: return write_geojson(path, zones, options, context);
    case Kind::svg: return write_svg(path, zones, options, context);
    case Kind::dxf: return write_dxf(path, zones, options, context);
    case Kind::ogr: return write_ogr(path, format.driver, zones, options, context);
  }
  return Error{ErrorCode::usage, "unknown format", "", ""};
}

}  // namespace

Result<ZoneFormat> find_zone_format(const std::string& path, const std::string& asked) {
  ogr::initialise();
  std::string extension = lower(std::filesystem::path(path).extension().string());
  if (!extension.empty()) extension.erase(0, 1);
  std::optional<ZoneFormat> format;
  if (!asked.empty()) {
    format = known_format(lower(asked));
    if (!format) format = driver_by_name(asked);
    if (!format) format = driver_by_extension(lower(asked));
    if (!format) {
      return Error{ErrorCode::usage, "unknown format '" + asked + "'", "", std::string("give --format ") + format_list};
    }
  } else if (path == "-") {
    format = known_format("wkt");
  } else {
    format = known_format(extension);
    if (!format && !extension.empty()) format = driver_by_extension(extension);
    if (!format) {
      std::string what = extension.empty() ? "the format of a file without extension is not known"
                                           : "the extension ." + extension + " belongs to no known format";
      return Error{ErrorCode::usage, what, "", std::string("give --format ") + format_list};
    }
  }
  if (path == "-" && !format->is_text()) {
    return Error{ErrorCode::usage, "format " + format->name + " cannot go to standard output", "",
                 "choose wkt, geojson, svg or dxf, or name a file"};
  }
  return *format;
}

std::vector<ZoneFeature> zone_features(const Zone& zone, bool separate) {
  auto polygons = static_cast<std::uint32_t>(zone.polygon_count());
  std::optional<double> radius;
  if (zone.least_radius() == zone.radius()) radius = zone.signed_radius();
  if (!separate) return {{0, polygons, radius, zone.area(), zone.perimeter(), zone.hole_count(), zone.inner_radius()}};
  std::vector<ZoneFeature> features;
  features.reserve(polygons);
  for (std::uint32_t p = 0; p < polygons; ++p) {
    Zone::Polygon polygon = zone.polygon(p);
    RingMeasure total = measure_ring(zone, polygon.outer);
    for (std::uint32_t hole : polygon.holes) {
      RingMeasure measure = measure_ring(zone, hole);
      total.area += measure.area;
      total.length += measure.length;
    }
    features.push_back({p, 1, radius, total.area, total.length, polygon.holes.size(), zone.inner_radius()});
  }
  return features;
}

double max_error_for(const ZoneFileOptions& options, double radius) {
  return options.max_error > 0 ? options.max_error : radius / 1000;
}

Result<ZoneFileReport> write_zones(const std::string& path, std::span<const Zone> zones, const ZoneFormat& format,
                                   const ZoneFileOptions& options, const Context& context) {
  for (const Zone& zone : zones) {
    if (max_error_for(options, zone.radius()) < Linearizer::finest(zone.radius())) {
      return Error{ErrorCode::usage, "--max-error is too small for the radius", "", "give at least 1e-12 of the radius"};
    }
  }
  if (context.cancelled()) return interrupted_while_writing();
  return write_as(path, zones, format, options, context);
}

}  // namespace krepl::output
