#include "output/ogr_dataset.hpp"

#include "output/atomic_file.hpp"

namespace krepl::output {

namespace {

/// Empty geometries come back as none from some formats.
bool holds_something(const OGRFeature& feature) {
  const OGRGeometry* geometry = feature.GetGeometryRef();
  return geometry != nullptr && !geometry->IsEmpty();
}

}  // namespace

OgrDataset::OgrDataset(std::string driver, const std::string& crs)
    : driver_(std::move(driver)),
      fixed_date_("OGR_CURRENT_DATE", file_date("%Y-%m-%dT%H:%M:%S.000Z")),
      lazy_("OGR_SQLITE_SYNCHRONOUS", "OFF") {
  if (!crs.empty()) {
    crs_.importFromWkt(crs.c_str());
    crs_.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  } else if (driver_ == "GPKG") {
    crs_.SetLocalCS("Undefined Cartesian SRS");  // else it records "undefined geographic", and coordinates are plane
  }
}

Status OgrDataset::create(const std::string& path) {
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(driver_.c_str());
  if (driver == nullptr) return failure("GDAL has no driver " + driver_);
  dataset_.reset(driver->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  if (!dataset_) return failure("cannot be written");
  transaction_ = dataset_->TestCapability(ODsCTransactions) && dataset_->StartTransaction() == OGRERR_NONE;
  return std::monostate{};
}

Result<OGRLayer*> OgrDataset::create_layer(const char* name, OGRwkbGeometryType type, const Fields& fields,
                                           std::vector<std::string> options) {
  messages_.clear();
  if (driver_ == "ESRI Shapefile") options.push_back("DBF_DATE_LAST_UPDATE=" + file_date("%Y-%m-%d"));
  if (driver_ == "CSV") options.emplace_back("GEOMETRY=AS_WKT");
  std::vector<char*> list;
  for (std::string& option : options) list.push_back(option.data());
  list.push_back(nullptr);
  OGRLayer* layer = dataset_->CreateLayer(name, crs_.IsEmpty() ? nullptr : &crs_, type, list.data());
  if (layer == nullptr) return failure("cannot be written");
  has_fields_ = layer->TestCapability(OLCCreateField);
  for (const auto& [field_name, field_type] : fields) {
    OGRFieldDefn field(field_name, field_type);
    if (has_fields_ && layer->CreateField(&field) != OGRERR_NONE) {
      return failure(std::string("field ") + field_name + " cannot be written");
    }
  }
  return layer;
}

Status OgrDataset::add(OGRLayer& layer, OGRFeature& feature) {
  messages_.clear();
  if (layer.CreateFeature(&feature) != OGRERR_NONE || messages_.failed()) return failure("cannot be written");
  if (holds_something(feature)) ++added_;
  return std::monostate{};
}

Status OgrDataset::close() {
  messages_.clear();
  if (transaction_ && dataset_->CommitTransaction() != OGRERR_NONE) return failure("cannot be written");
  dataset_->FlushCache(true);
  dataset_.reset();
  if (messages_.failed()) return failure("cannot be written");
  return std::monostate{};
}

Status OgrDataset::check_count(const std::string& path) {
  if (driver_ == "GPKG") return std::monostate{};
  messages_.clear();
  const std::unique_ptr<GDALDataset> again(
      GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
  if (!again || again->GetLayerCount() == 0) return failure("cannot be read back after writing");
  std::size_t found = 0;
  for (const auto& feature : *again->GetLayer(0)) found += holds_something(*feature) ? 1 : 0;
  if (messages_.failed() || found != added_) return failure("is not complete after writing");
  return std::monostate{};
}

Status write_dataset(const std::string& path, const std::string& driver, const std::string& crs,
                     std::vector<std::string>& notes, const std::function<Status(OgrDataset&)>& write) {
  ogr::initialise();
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  {
    OgrDataset dataset(driver, crs);
    if (Status created = dataset.create(file->temporary_path()); !created) return created;
    if (Status written = write(dataset); !written) return written;
    if (!dataset.has_fields()) notes.push_back("note: " + driver + " holds no attributes; there are geometries only");
    if (Status closed = dataset.close(); !closed) return closed;
    if (Status whole = dataset.check_count(file->temporary_path()); !whole) return whole;
  }
  return file->commit();
}

}  // namespace krepl::output
