#pragma once

#include <ogrsf_frmts.h>

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "krepl/error.hpp"

namespace krepl::output {

/// Attributes of input features by the features' numbers.
using AttributeRows = std::unordered_map<std::int64_t, std::shared_ptr<const OGRFeature>>;

/// The fields of the input that the features of a result keep, with their names and types. A type that the format does
/// not know becomes text, with a note; a name that the layer has already becomes input_NAME.
class KeptFields {
 public:
  /// `from`: the input's fields, null for none; `only`: of these, the ones to keep, empty for all.
  explicit KeptFields(const OGRFeatureDefn* from = nullptr, std::vector<std::string> only = {})
      : from_(from), only_(std::move(only)) {}

  /// Whether a field of this name is kept.
  bool has(const std::string& name) const;
  /// Adds them to a layer.
  Status create(OGRLayer& layer, const std::string& driver, std::vector<std::string>& notes);
  /// Copies the values, after create().
  void copy(const OGRFeature& from, OGRFeature& to) const;

 private:
  bool is_kept(const std::string& name) const;

  const OGRFeatureDefn* from_;
  std::vector<std::string> only_;
  std::vector<int> target_;  // the layer's field for each of the input's; -1: not kept
};

/// Adds a field and gives its number: the driver may change its name (Shapefile cuts it).
Status create_field(OGRLayer& layer, const OGRFieldDefn& field, int& number);

}  // namespace krepl::output
