#include "input/flow_field.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <optional>

#include "input/geometry_source.hpp"
#include "input/whole_file.hpp"

namespace krepl::input {

namespace {

enum class Sense { with, against, unknown };

std::string simplified(const char* value) {
  std::string text;
  for (const char* c = value; *c != 0; ++c) {
    if (*c != ' ' && *c != '_' && *c != '-') text += char(std::tolower(static_cast<unsigned char>(*c)));
  }
  return text;
}

template <std::size_t n>
bool is_one_of(const std::string& text, const std::array<const char*, n>& words) {
  return std::find(words.begin(), words.end(), text) != words.end();
}

std::optional<Sense> sense_of(const char* value) {
  const std::string all = value;
  double number = 0;
  const auto [end, status] = std::from_chars(all.data(), all.data() + all.size(), number);
  if (!all.empty() && status == std::errc{} && end == all.data() + all.size()) {
    return number > 0 ? Sense::with : number < 0 ? Sense::against : Sense::unknown;
  }
  const std::string text = simplified(value);
  if (is_one_of(text, std::array{"with", "forward", "yes", "true", "f", "ft", "withdigitized", "withdigitised"}))
    return Sense::with;
  if (is_one_of(text,
                std::array{"against", "backward", "reverse", "t", "tf", "againstdigitized", "againstdigitised"})) {
    return Sense::against;
  }
  if (is_one_of(text, std::array{"", "unknown", "uninitialized", "uninitialised"})) return Sense::unknown;
  return std::nullopt;
}

Result<int> field_index(const OGRFeature& feature, const std::string& field) {
  const int index = feature.GetFieldIndex(field.c_str());
  if (index >= 0) return index;
  std::string names;
  for (int i = 0; i < feature.GetFieldCount(); ++i) {
    names += (i == 0 ? "" : ", ") + std::string(feature.GetFieldDefnRef(i)->GetNameRef());
  }
  return Error{ErrorCode::input, "there is no field '" + field + "'", "",
               names.empty() ? "the layer has no fields" : "the fields are: " + names};
}

}  // namespace

Result<FlowField> read_flow_field(const NetworkRequest& request, const std::string& field, const Context& context) {
  if (is_stream(request.path)) {
    return Error{ErrorCode::usage, "a field of standard input cannot be read", "", "give a file"};
  }
  auto source = open_geometry_source(request.path, {request.layer, request.where}, context);
  if (!source) return source.error();
  FlowField result;
  for (;;) {
    if (context.cancelled()) return Error{ErrorCode::cancelled, "interrupted while reading", "", ""};
    auto item = (*source)->next();
    if (!item) return item.error();
    if (!item->has_value()) return result;
    const GeometrySource::Item& record = **item;
    if (record.feature == nullptr) {
      return Error{ErrorCode::usage, "a file of plain geometries has no fields", "", "leave out --flow-field"};
    }
    Result<int> index = field_index(*record.feature, field);
    if (!index) return index.error();
    const bool set = record.feature->IsFieldSetAndNotNull(*index) != 0;
    const std::string value = set ? const_cast<OGRFeature*>(record.feature)->GetFieldAsString(*index) : "";
    const std::optional<Sense> sense = sense_of(value.c_str());
    if (!sense) {
      return Error{ErrorCode::input, "field '" + field + "' says '" + value + "'", (*source)->place(record.number),
                   "use 1 or 'with', -1 or 'against', 0 or nothing"};
    }
    if (*sense == Sense::against) result.against.push_back(record.number);
    if (*sense == Sense::unknown) ++result.unknown;
  }
}

}  // namespace krepl::input
