#pragma once

#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "krepl/error.hpp"
#include "ogr/message_capture.hpp"
#include "output/ogr_options.hpp"

namespace krepl::output {

/// A vector file being written by an OGR driver, every failure noticed; the steps that all layers of results share. The
/// path is that of an AtomicFile, so nothing is flushed before the end.
class OgrDataset {
 public:
  using Fields = std::vector<std::pair<const char*, OGRFieldType>>;

  /// `crs` is WKT, empty for none.
  OgrDataset(std::string driver, const std::string& crs);

  Status create(const std::string& path);
  /// `options` as NAME=VALUE. A driver that takes no fields (DXF) gets none; has_fields() tells afterwards.
  Result<OGRLayer*> create_layer(const char* name, OGRwkbGeometryType type, const Fields& fields,
                                 std::vector<std::string> options = {});
  Status add(OGRLayer& layer, OGRFeature& feature);
  /// Commits and closes.
  Status close();

  /// After close(): reads a file of one layer back, for drivers do not always tell of a failed write (SQLite does).
  Status check_count(const std::string& path);

  bool has_fields() const { return has_fields_; }
  bool can(const char* capability) const { return dataset_->TestCapability(capability); }
  const std::string& driver() const { return driver_; }

 private:
  Error failure(const std::string& what) const {
    return messages_.error(ErrorCode::io, what, "", "free some space, or choose another place or format");
  }

  const std::string driver_;
  ogr::MessageCapture messages_;
  ScopedOption fixed_date_, lazy_;
  OGRSpatialReference crs_;
  std::unique_ptr<GDALDataset> dataset_;
  bool transaction_ = false, has_fields_ = true;
  std::size_t added_ = 0;
};

/// A file of an OGR driver, whole or not at all, its layers made by `write`.
Status write_dataset(const std::string& path, const std::string& driver, const std::string& crs,
                     std::vector<std::string>& notes, const std::function<Status(OgrDataset&)>& write);

}  // namespace krepl::output
