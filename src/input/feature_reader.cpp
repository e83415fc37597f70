#include "input/feature_reader.hpp"

#include <cmath>

#include "input/collected.hpp"
#include "input/field_values.hpp"
#include "input/projection.hpp"
#include "input/whole_file.hpp"
#include "ogr/spatial_reference.hpp"

namespace krepl::input {

namespace {

/// The feature's attributes without its geometry.
std::unique_ptr<OGRFeature> attributes_of(const OGRFeature& feature) {
  auto row = std::make_unique<OGRFeature>(const_cast<OGRFeature&>(feature).GetDefnRef());
  std::vector<int> same(std::size_t(feature.GetFieldCount()));
  for (std::size_t i = 0; i < same.size(); ++i) same[i] = int(i);
  row->SetFieldsFrom(&feature, same.data(), TRUE);
  row->SetFID(feature.GetFID());
  return row;
}

/// What is wrong with a number as a radius, or nothing.
std::string radius_fault(const FieldNumber& number) {
  if (!number.value) return number.fault;
  if (!std::isfinite(*number.value)) return "is not finite";
  if (*number.value == 0) return "is zero";
  if (*number.value < 0) return "is negative";
  return "";
}

Result<std::vector<double>> radii_of(const FeatureRequest& request, const FeatureData& data) {
  const bool field = !request.radius_field.empty();
  const std::string what = field ? "the radius in field '" + request.radius_field + "'"
                                 : "the radius '" + request.radius_expression + "'";
  if (data.row.empty()) return Error{ErrorCode::input, "has no fields for " + what, "", "give a format with attributes"};
  const auto numbers =
      field ? field_numbers(data.row, request.radius_field) : expression_numbers(data.row, request.radius_expression);
  if (!numbers) return numbers.error();
  std::vector<double> radii;
  radii.reserve(numbers->size());
  for (std::size_t i = 0; i < numbers->size(); ++i) {
    if (const std::string fault = radius_fault((*numbers)[i]); !fault.empty()) {
      return Error{ErrorCode::input, what + " " + fault, data.place[i],
                   "give a finite number greater than zero, or leave the feature out with --where"};
    }
    radii.push_back(*(*numbers)[i].value);
  }
  return radii;
}

Status check_group_field(const std::string& name, const FeatureData& data) {
  if (name.empty()) return std::monostate{};
  if (data.row.empty())
    return Error{ErrorCode::input, "has no field '" + name + "'", "", "give a format with attributes"};
  const OGRFeatureDefn& definition = *data.row.front()->GetDefnRef();
  if (definition.GetFieldIndex(name.c_str()) >= 0) return std::monostate{};
  return Error{ErrorCode::input, "there is no field '" + name + "'", "", known_fields(definition)};
}

}  // namespace

Result<std::unordered_map<std::int64_t, std::shared_ptr<const OGRFeature>>> read_attributes(const NetworkRequest& request,
                                                                                           const Context& context) {
  std::unordered_map<std::int64_t, std::shared_ptr<const OGRFeature>> rows;
  if (is_stream(request.path)) return rows;
  auto source = open_geometry_source(request.path, {request.layer, request.where}, context);
  if (!source) return source.error();
  for (;;) {
    if (context.cancelled()) return Error{ErrorCode::cancelled, "interrupted while reading", "", ""};
    auto item = (*source)->next();
    if (!item) return item.error();
    if (!item->has_value()) return rows;
    const GeometrySource::Item& record = **item;
    if (record.feature == nullptr) return rows;
    if (record.geometry != nullptr) rows.emplace(record.number, attributes_of(*record.feature));
  }
}

Result<FeatureData> read_features(const FeatureRequest& request, const Context& context) {
  const NetworkRequest& network = request.network;
  auto source = open_geometry_source(network.path, {network.layer, network.where}, context);
  if (!source) return source.error();
  FeatureData data;
  Result<Collected> all = collect(**source, {network.arc_error, network.keep_arcs}, context,
                                   [&](const GeometrySource::Item& item, std::size_t parts) {
    if (parts == data.part_begin.back()) return;
    if (item.feature != nullptr) data.row.push_back(attributes_of(*item.feature));
    data.place.push_back((*source)->place(item.number));
    data.part_begin.push_back(parts);
  });
  if (!all) return all.error();
  if (all->parts.size() == 0) return nothing_found(network, *all);
  data.notes = notes_on(*all, **source);
  data.parts = std::move(all->parts);
  if (Status there = check_group_field(request.group_field, data); !there) return there.error();
  if (!request.radius_field.empty() || !request.radius_expression.empty()) {
    auto radii = radii_of(request, data);
    if (!radii) return radii.error();
    data.radius = std::move(*radii);
  }
  Result<std::optional<OGRSpatialReference>> crs = crs_of_data(network, **source);
  if (!crs) return crs.error();
  const auto place = [&](std::int64_t number) { return (*source)->place(number); };
  if (Status plain = check_projection(data.parts, network.to_crs, place); !plain) return plain.error();
  auto plane = project(data.parts, {*crs, network.to_crs, place}, data.notes, context);
  if (!plane) return plane.error();
  if (plane->has_value()) data.crs = ogr::crs_definition(**plane);
  return data;
}

}  // namespace krepl::input
