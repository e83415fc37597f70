#include "output/feature_file.hpp"

#include <gdal_priv.h>

#include <algorithm>
#include <sstream>

#include "output/ogr_dataset.hpp"
#include "output/output_stream.hpp"
#include "output/zone_writers.hpp"

namespace krepl::output {

namespace {

/// Types that a driver says it can write; all where it does not say.
bool knows_type(const std::string& driver_name, OGRFieldType type) {
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(driver_name.c_str());
  const char* types = driver != nullptr ? driver->GetMetadataItem(GDAL_DMD_CREATIONFIELDDATATYPES) : nullptr;
  if (types == nullptr) return true;
  std::istringstream words(types);
  for (std::string word; words >> word;) {
    if (word == OGRFieldDefn::GetFieldTypeName(type)) return true;
  }
  return false;
}

bool equal_names(const std::string& a, const std::string& b) { return EQUAL(a.c_str(), b.c_str()); }

class FeatureWriter {
 public:
  FeatureWriter(const FeatureColumns& columns, OgrDataset& dataset, ZoneFileReport& report)
      : columns_(columns), dataset_(dataset), report_(report) {}

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
  bool is_kept(const std::string& name) const {
    return columns_.only.empty() || std::any_of(columns_.only.begin(), columns_.only.end(),
                                                [&](const std::string& only) { return equal_names(only, name); });
  }
  bool is_taken(const std::string& name) const {
    for (int i = 0; columns_.kept != nullptr && i < columns_.kept->GetFieldCount(); ++i) {
      const char* kept = columns_.kept->GetFieldDefn(i)->GetNameRef();
      if (is_kept(kept) && equal_names(kept, name)) return true;
    }
    return false;
  }

  Status make_layer(bool curves) {
    std::vector<std::string> options;
    if (dataset_.driver() == "FlatGeobuf") options.emplace_back("SPATIAL_INDEX=NO");  // it would reorder the features
    if (dataset_.driver() == "GPKG") {
      // Names of the driver's own columns give way to fields of the input.
      options.push_back(std::string("FID=") + (is_taken("fid") ? "krepl_fid" : "fid"));
      options.push_back(std::string("GEOMETRY_NAME=") + (is_taken("geom") ? "krepl_geom" : "geom"));
    }
    Result<OGRLayer*> layer = dataset_.create_layer("zone", curves ? wkbMultiSurface : wkbMultiPolygon, {}, options);
    if (!layer) return layer.error();
    layer_ = *layer;
    if (!dataset_.has_fields()) return std::monostate{};
    const int kept = columns_.kept != nullptr ? columns_.kept->GetFieldCount() : 0;
    for (int i = 0; i < kept; ++i) {
      target_.push_back(-1);
      if (Status made = keep_field(*columns_.kept->GetFieldDefn(i)); !made) return made;
    }
    for (const auto& added : columns_.added) {
      const OGRFieldDefn field(is_taken(added.name) ? ("zone_" + std::string(added.name)).c_str() : added.name, added.type);
      if (Status made = create(field, added_.emplace_back(-1)); !made) return made;
    }
    return std::monostate{};
  }

  Status keep_field(const OGRFieldDefn& from) {
    if (!is_kept(from.GetNameRef())) return std::monostate{};
    OGRFieldDefn field(&from);
    field.SetUnique(FALSE);  // a feature may come several times
    field.SetNullable(TRUE);
    field.SetDefault(nullptr);
    field.SetDomainName("");
    if (!knows_type(dataset_.driver(), field.GetType())) {
      report_.notes.push_back("note: " + dataset_.driver() + " has no type " +
                              OGRFieldDefn::GetFieldTypeName(field.GetType()) + "; field " + field.GetNameRef() +
                              " becomes text");
      field.SetSubType(OFSTNone);
      field.SetType(OFTString);
      field.SetWidth(0);
    }
    return create(field, target_.back());
  }

  /// The driver may change the name (Shapefile cuts it), so fields go by number.
  Status create(const OGRFieldDefn& field, int& number) {
    number = layer_->GetLayerDefn()->GetFieldCount();
    OGRFieldDefn copy(&field);
    if (layer_->CreateField(&copy) == OGRERR_NONE && layer_->GetLayerDefn()->GetFieldCount() > number)
      return std::monostate{};
    return Error{ErrorCode::io, std::string("field ") + field.GetNameRef() + " cannot be written", "",
                 "choose another format"};
  }

  Status add(ZoneRow& row) {
    OGRFeature feature(layer_->GetLayerDefn());
    if (dataset_.has_fields()) {
      if (row.attributes != nullptr && !target_.empty()) feature.SetFieldsFrom(row.attributes, target_.data(), TRUE);
      for (std::size_t i = 0; i < row.values.size(); ++i) feature.SetField(added_[i], row.values[i]);
    }
    feature.SetGeometryDirectly(row.geometry.release());
    return dataset_.add(*layer_, feature);
  }

  const FeatureColumns& columns_;
  OgrDataset& dataset_;
  ZoneFileReport& report_;
  OGRLayer* layer_ = nullptr;
  std::vector<int> target_, added_;  // the layer's field for each kept (-1: not kept) and each added one
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
