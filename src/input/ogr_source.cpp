// Layers of OGR data sources.
#include <gdal_priv.h>

#include <algorithm>

#include "input/geometry_source.hpp"
#include "ogr/message_capture.hpp"

namespace krepl::input {

namespace {

using Dataset = std::unique_ptr<GDALDataset>;

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

Result<Dataset> open_dataset(const std::string& vsi_path) {
  ogr::initialise();
  ogr::MessageCapture messages;
  Dataset dataset(GDALDataset::Open(vsi_path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
  if (!dataset) {
    return messages.error(ErrorCode::input, "is not a vector file that can be read", "",
                          "convert it to GeoPackage with ogr2ogr");
  }
  return dataset;
}

std::vector<std::string> layer_names(GDALDataset& dataset, bool with_geometry_only) {
  std::vector<std::string> names;
  for (OGRLayer* layer : dataset.GetLayers()) {
    if (!with_geometry_only || layer->GetGeomType() != wkbNone) names.emplace_back(layer->GetName());
  }
  return names;
}

Result<OGRLayer*> choose_layer(GDALDataset& dataset, const std::string& wanted) {
  std::vector<std::string> with_geometry = layer_names(dataset, true);
  if (!wanted.empty()) {
    OGRLayer* layer = dataset.GetLayerByName(wanted.c_str());
    if (layer == nullptr) {
      return Error{ErrorCode::input, "there is no layer '" + wanted + "'", "",
                   "the layers are: " + joined(layer_names(dataset, false))};
    }
    if (layer->GetGeomType() == wkbNone) {
      return Error{ErrorCode::input, "layer '" + wanted + "' has no geometry", "",
                   "the layers with geometry are: " + joined(with_geometry)};
    }
    return layer;
  }
  if (with_geometry.empty()) return Error{ErrorCode::input, "has no geometry", "", "give lines, polygons or points"};
  if (with_geometry.size() > 1) {
    return Error{ErrorCode::input, "has more than one layer", "", "choose with --layer one of: " + joined(with_geometry)};
  }
  return dataset.GetLayerByName(with_geometry.front().c_str());
}

Status select_features(OGRLayer& layer, const std::string& where) {
  if (where.empty()) return std::monostate{};
  ogr::MessageCapture messages;
  if (layer.SetAttributeFilter(where.c_str()) == OGRERR_NONE && !messages.failed()) return std::monostate{};
  std::vector<std::string> fields;
  const OGRFeatureDefn& definition = *layer.GetLayerDefn();
  for (int i = 0; i < definition.GetFieldCount(); ++i) fields.emplace_back(definition.GetFieldDefn(i)->GetNameRef());
  return messages.error(ErrorCode::input, "--where '" + where + "' cannot be used", "",
                        fields.empty() ? "the layer has no fields" : "the fields are: " + joined(fields));
}

class OgrSource : public GeometrySource {
 public:
  OgrSource(Dataset dataset, OGRLayer& layer) : dataset_(std::move(dataset)), layer_(layer) {
    ogr::MessageCapture ignored;
    if (const OGRSpatialReference* reference = layer_.GetSpatialRef(); reference != nullptr) {
      crs_ = *reference;
      crs_->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    }
    count_ = layer_.GetFeatureCount(FALSE);
    layer_.ResetReading();
  }

  Result<std::optional<Item>> next() override {
    ogr::MessageCapture messages;
    feature_.reset(layer_.GetNextFeature());
    // A reader that stops at damage reports it and then looks as if at the end: half a file must not pass for a whole one.
    if (messages.failed()) return messages.error(ErrorCode::io, "cannot be read", after(), "repair or convert the file");
    if (!feature_) return std::optional<Item>{};
    ++read_;
    last_ = feature_->GetFID();
    return std::optional<Item>{Item{last_, feature_->GetGeometryRef(), feature_.get()}};
  }

  std::optional<OGRSpatialReference> crs() const override { return crs_; }
  const char* number_name() const override { return "feature"; }
  double fraction() const override {
    return count_ > 0 ? std::min(1.0, static_cast<double>(read_) / static_cast<double>(count_)) : 0;
  }
  std::vector<std::string> notes() const override {
    if (std::string(dataset_->GetDriverName()) != "DXF") return {};
    return {"note: GDAL reads arcs, bulges and splines of DXF as chords of 4 degrees"};
  }

 private:
  std::string after() const { return read_ == 0 ? "at the first feature" : "after feature " + std::to_string(last_); }

  Dataset dataset_;
  OGRLayer& layer_;
  std::optional<OGRSpatialReference> crs_;
  std::unique_ptr<OGRFeature> feature_;
  std::int64_t count_ = 0, read_ = 0, last_ = 0;
};

}  // namespace

Result<std::unique_ptr<GeometrySource>> open_ogr_source(const std::string& vsi_path, const SourceSelection& selection) {
  Result<Dataset> dataset = open_dataset(vsi_path);
  if (!dataset) return dataset.error();
  Result<OGRLayer*> layer = choose_layer(**dataset, selection.layer);
  if (!layer) return layer.error();
  if (Status selected = select_features(**layer, selection.where); !selected) return selected.error();
  OGRLayer& chosen = **layer;
  return std::unique_ptr<GeometrySource>(new OgrSource(std::move(*dataset), chosen));
}

Result<std::vector<std::string>> geometry_layers(const std::string& path) {
  Result<std::string> vsi_path = checked_path(path);
  if (!vsi_path) return vsi_path.error();
  Result<Dataset> dataset = open_dataset(*vsi_path);
  if (!dataset) return dataset.error();
  return layer_names(**dataset, true);
}

}  // namespace krepl::input
