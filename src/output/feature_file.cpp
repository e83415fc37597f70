#include "output/feature_file.hpp"

#include <gdal_priv.h>

#include <algorithm>

#include "output/kept_fields.hpp"
#include "output/ogr_dataset.hpp"
#include "output/output_stream.hpp"
#include "output/zone_writers.hpp"

namespace krepl::output {

namespace {

class FeatureWriter {
 public:
  FeatureWriter(const FeatureColumns& columns, OgrDataset& dataset, ZoneFileReport& report)
      : columns_(columns), dataset_(dataset), report_(report), kept_(columns.kept, columns.only) {}

  Status write(const NextRow& next) {
    // The driver would find out in quadratic time which ring is a hole; geometries have rings in their right sense.
    const ScopedOption as_given("SHAPE_REWIND_ON_WRITE", "NO");
    GeometryStyle style;
    style.curves = dataset_.can(ODsCCurveGeometries);
    if (dataset_.driver() == "ESRI Shapefile") style.sense = OuterSense::clockwise;
    if (Status made = make_layer(style.curves); !made) return made;
    for (;;) {
      auto row = next(style);
      if (!row) return row.error();
      if (!row->has_value()) return std::monostate{};
      if (Status added = add(**row); !added) return added;
      if (!style.curves || (*row)->deviation > 0) report_.deviation = std::max(report_.deviation.value_or(0), (*row)->deviation);
    }
  }

 private:
  Status make_layer(bool curves) {
    std::vector<std::string> options;
    if (dataset_.driver() == "FlatGeobuf") options.emplace_back("SPATIAL_INDEX=NO");  // it would reorder the features
    if (dataset_.driver() == "GPKG") {
      // Names of the driver's own columns give way to fields of the input.
      options.push_back(std::string("FID=") + (kept_.has("fid") ? "krepl_fid" : "fid"));
      options.push_back(std::string("GEOMETRY_NAME=") + (kept_.has("geom") ? "krepl_geom" : "geom"));
    }
    Result<OGRLayer*> layer = dataset_.create_layer("zone", curves ? wkbMultiSurface : wkbMultiPolygon, {}, options);
    if (!layer) return layer.error();
    layer_ = *layer;
    if (!dataset_.has_fields()) return std::monostate{};
    if (Status made = kept_.create(*layer_, dataset_.driver(), report_.notes); !made) return made;
    for (const auto& added : columns_.added) {
      const std::string name = (kept_.has(added.name) ? "zone_" : "") + std::string(added.name);
      const OGRFieldDefn field(name.c_str(), added.type);
      if (Status made = create_field(*layer_, field, added_.emplace_back(-1)); !made) return made;
    }
    return std::monostate{};
  }

  Status add(ZoneRow& row) {
    OGRFeature feature(layer_->GetLayerDefn());
    if (dataset_.has_fields()) {
      if (row.attributes != nullptr) kept_.copy(*row.attributes, feature);
      for (std::size_t i = 0; i < row.values.size(); ++i) feature.SetField(added_[i], row.values[i]);
    }
    feature.SetGeometryDirectly(row.geometry.release());
    return dataset_.add(*layer_, feature);
  }

  const FeatureColumns& columns_;
  OgrDataset& dataset_;
  ZoneFileReport& report_;
  OGRLayer* layer_ = nullptr;
  KeptFields kept_;
  std::vector<int> added_;  // the layer's field for each added one
};

/// WKT: a geometry a line; WKB: one after the other. Neither holds attributes.
Status write_plain(const std::string& path, bool binary, const NextRow& next, ZoneFileReport& report) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  GeometryStyle style;
  style.curves = true;
  std::vector<unsigned char> bytes;
  OGRWktOptions text;
  text.variant = wkbVariantIso;
  text.precision = 17;
  text.round = false;
  text.format = OGRWktFormat::G;
  for (;;) {
    auto row = next(style);
    if (!row) return row.error();
    if (!row->has_value()) break;
    if ((*row)->deviation > 0) report.deviation = std::max(report.deviation.value_or(0), (*row)->deviation);
    const OGRGeometry* geometry = (*row)->geometry.get();
    if (binary) {
      bytes.resize(geometry->WkbSize());
      if (geometry->exportToWkb(wkbNDR, bytes.data(), wkbVariantIso) != OGRERR_NONE)
        return Error{ErrorCode::io, "geometry cannot be written as WKB", "", ""};
      stream->write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    } else {
      OGRErr status = OGRERR_NONE;
      stream->write(geometry->exportToWkt(text, &status) + "\n");
      if (status != OGRERR_NONE) return Error{ErrorCode::io, "geometry cannot be written as WKT", "", ""};
    }
  }
  return stream->finish();
}

}  // namespace

bool holds_features(const ZoneFormat& format) {
  return format.kind != ZoneFormat::Kind::svg && format.kind != ZoneFormat::Kind::dxf;
}

Result<ZoneFileReport> write_features(const std::string& path, const ZoneFormat& format, const std::string& crs,
                                      const FeatureColumns& columns, const NextRow& next) {
  ZoneFileReport report;
  Status written = std::monostate{};
  if (format.kind == ZoneFormat::Kind::wkt || format.kind == ZoneFormat::Kind::wkb) {
    written = write_plain(path, format.kind == ZoneFormat::Kind::wkb, next, report);
  } else {
    const std::string driver = format.kind == ZoneFormat::Kind::geojson ? "GeoJSON" : format.driver;
    written = write_dataset(path, driver, crs, report.notes, [&](OgrDataset& dataset) {
      return FeatureWriter(columns, dataset, report).write(next);
    });
  }
  if (!written) return written.error();
  return report;
}

}  // namespace krepl::output
