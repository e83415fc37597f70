#include "output/kept_fields.hpp"

#include <gdal_priv.h>

#include <algorithm>
#include <sstream>

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

bool is_taken(OGRLayer& layer, const char* name) {
  return layer.GetLayerDefn()->GetFieldIndex(name) >= 0 || equal_names(layer.GetFIDColumn(), name) ||
         equal_names(layer.GetGeometryColumn(), name);
}

}  // namespace

bool KeptFields::is_kept(const std::string& name) const {
  return only_.empty() ||
         std::any_of(only_.begin(), only_.end(), [&](const std::string& only) { return equal_names(only, name); });
}

bool KeptFields::has(const std::string& name) const {
  for (int i = 0; from_ != nullptr && i < from_->GetFieldCount(); ++i) {
    const char* field = from_->GetFieldDefn(i)->GetNameRef();
    if (is_kept(field) && equal_names(field, name)) return true;
  }
  return false;
}

Status KeptFields::create(OGRLayer& layer, const std::string& driver, std::vector<std::string>& notes) {
  target_.clear();
  for (int i = 0; from_ != nullptr && i < from_->GetFieldCount(); ++i) {
    const OGRFieldDefn& from = *from_->GetFieldDefn(i);
    int& number = target_.emplace_back(-1);
    if (!is_kept(from.GetNameRef())) continue;
    OGRFieldDefn field(&from);
    field.SetUnique(FALSE);  // a feature may come several times
    field.SetNullable(TRUE);
    field.SetDefault(nullptr);
    field.SetDomainName("");
    if (is_taken(layer, field.GetNameRef())) field.SetName(("input_" + std::string(from.GetNameRef())).c_str());
    if (!knows_type(driver, field.GetType())) {
      notes.push_back("note: " + driver + " has no type " + OGRFieldDefn::GetFieldTypeName(field.GetType()) + "; field " +
                      field.GetNameRef() + " becomes text");
      field.SetSubType(OFSTNone);
      field.SetType(OFTString);
      field.SetWidth(0);
    }
    if (Status made = create_field(layer, field, number); !made) return made;
  }
  return std::monostate{};
}

void KeptFields::copy(const OGRFeature& from, OGRFeature& to) const {
  if (!target_.empty()) to.SetFieldsFrom(&from, target_.data(), TRUE);
}

Status create_field(OGRLayer& layer, const OGRFieldDefn& field, int& number) {
  number = layer.GetLayerDefn()->GetFieldCount();
  OGRFieldDefn copy(&field);
  if (layer.CreateField(&copy) == OGRERR_NONE && layer.GetLayerDefn()->GetFieldCount() > number) return std::monostate{};
  return Error{ErrorCode::io, std::string("field ") + field.GetNameRef() + " cannot be written", "",
               "choose another format"};
}

}  // namespace krepl::output
