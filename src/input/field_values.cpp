#include "input/field_values.hpp"

#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <charconv>
#include <string_view>

#include "ogr/message_capture.hpp"

namespace krepl::input {

std::string known_fields(const OGRFeatureDefn& definition) {
  std::string names;
  for (int i = 0; i < definition.GetFieldCount(); ++i) {
    names += (names.empty() ? "" : ", ") + std::string(definition.GetFieldDefn(i)->GetNameRef());
  }
  return names.empty() ? "the layer has no fields" : "the fields are: " + names;
}

namespace {

FieldNumber number_of(const OGRFeature& row, int field) {
  if (field < 0 || !row.IsFieldSetAndNotNull(field)) return {{}, "is null"};
  const OGRFieldType type = row.GetFieldDefnRef(field)->GetType();
  OGRFeature& readable = const_cast<OGRFeature&>(row);  // GetFieldAsString keeps its text there
  if (type == OFTInteger || type == OFTInteger64 || type == OFTReal) return {readable.GetFieldAsDouble(field), ""};
  const std::string_view text = readable.GetFieldAsString(field);
  double value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (type == OFTString && !text.empty() && status == std::errc{} && end == text.data() + text.size()) return {value, ""};
  return {{}, "is '" + std::string(text) + "', not a number"};
}

/// A table in memory with the rows' scalar fields.
class Table {
 public:
  explicit Table(const OGRFeatureDefn& definition) {
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("Memory");
    if (driver == nullptr) return;
    dataset_.reset(driver->Create("", 0, 0, 0, GDT_Unknown, nullptr));
    if (dataset_) layer_ = dataset_->CreateLayer("features", nullptr, wkbNone, nullptr);
    if (layer_ == nullptr) return;
    for (int i = 0; i < definition.GetFieldCount(); ++i) {
      OGRFieldType type = definition.GetFieldDefn(i)->GetType();
      if (type == OFTInteger || type == OFTInteger64) type = OFTReal;
      if (type != OFTReal) type = OFTString;
      OGRFieldDefn field(definition.GetFieldDefn(i)->GetNameRef(), type);
      if (layer_->CreateField(&field) != OGRERR_NONE) layer_ = nullptr;
      if (layer_ == nullptr) return;
    }
  }

  bool add(const OGRFeature& row) {
    if (layer_ == nullptr) return false;
    OGRFeature copy(layer_->GetLayerDefn());
    std::vector<int> same(std::size_t(row.GetFieldCount()));
    for (std::size_t i = 0; i < same.size(); ++i) same[i] = int(i);
    copy.SetFieldsFrom(&row, same.data(), TRUE);
    return layer_->CreateFeature(&copy) == OGRERR_NONE;
  }

  GDALDataset* dataset() const { return layer_ == nullptr ? nullptr : dataset_.get(); }

 private:
  std::unique_ptr<GDALDataset> dataset_;
  OGRLayer* layer_ = nullptr;
};

}  // namespace

Result<std::vector<FieldNumber>> field_numbers(std::span<const std::unique_ptr<OGRFeature>> rows, const std::string& name) {
  const OGRFeatureDefn& definition = *rows.front()->GetDefnRef();
  const int field = definition.GetFieldIndex(name.c_str());
  if (field < 0) return Error{ErrorCode::input, "there is no field '" + name + "'", "", known_fields(definition)};
  std::vector<FieldNumber> numbers;
  numbers.reserve(rows.size());
  for (const auto& row : rows) numbers.push_back(number_of(*row, field));
  return numbers;
}

Result<std::vector<FieldNumber>> expression_numbers(std::span<const std::unique_ptr<OGRFeature>> rows,
                                                    const std::string& expression) {
  const OGRFeatureDefn& definition = *rows.front()->GetDefnRef();
  ogr::MessageCapture messages;
  const auto cannot = [&] {
    return messages.error(ErrorCode::input, "--radius '" + expression + "' cannot be used", "", known_fields(definition));
  };
  Table table(definition);
  for (const auto& row : rows) {
    if (!table.add(*row)) return cannot();
  }
  if (table.dataset() == nullptr) return cannot();
  const std::string sql = "SELECT (" + expression + ") AS krepl_radius FROM features";
  OGRLayer* result = table.dataset()->ExecuteSQL(sql.c_str(), nullptr, "SQLITE");
  if (result == nullptr) return cannot();
  std::vector<FieldNumber> numbers;
  numbers.reserve(rows.size());
  for (const auto& row : *result) numbers.push_back(number_of(*row, row->GetFieldIndex("krepl_radius")));
  const bool failed = messages.failed();
  table.dataset()->ReleaseResultSet(result);
  if (failed) return cannot();
  if (numbers.size() != rows.size()) {
    return Error{ErrorCode::input, "--radius '" + expression + "' is not a value for each feature", "",
                 "give an expression of a feature's own fields"};
  }
  return numbers;
}

}  // namespace krepl::input
