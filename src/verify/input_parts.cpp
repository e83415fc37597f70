#include "verify/input_parts.hpp"

#include "input/collected.hpp"
#include "input/feature_reader.hpp"
#include "input/geometry_source.hpp"
#include "input/parts.hpp"
#include "input/projection.hpp"
#include "ogr/spatial_reference.hpp"

namespace krepl::verify {

namespace {

Result<input::Parts> read_all(input::GeometrySource& source, double arc_error, bool keep_arcs, const Context& context) {
  input::Parts parts;
  parts.arc_error = arc_error;
  parts.keep_arcs = keep_arcs;
  for (;;) {
    if (context.cancelled()) return Error{ErrorCode::cancelled, "interrupted while reading", "", ""};
    auto item = source.next();
    if (!item) return item.error();
    if (!item->has_value()) return parts;
    const auto& record = **item;
    if (record.geometry == nullptr || record.geometry->IsEmpty()) continue;
    if (auto added = parts.add(*record.geometry, record.number, source.place(record.number)); !added)
      return added.error();
  }
}

std::vector<InputPart> plain(const input::Parts& parts) {
  std::vector<InputPart> out;
  out.reserve(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i)
    out.push_back({{parts.points.begin() + std::ptrdiff_t(parts.begin[i]),
                    parts.points.begin() + std::ptrdiff_t(parts.begin[i + 1])},
                   parts.kind[i] == input::Parts::Kind::ring,
                   parts.feature[i],
                   0,
                   parts.middles_of(i)});
  return out;
}

Result<std::vector<InputPart>> read_parts_with_radii(const InputRequest& request, const Context& context) {
  auto features = input::read_features({network_request(request), request.radius_field, request.radius_expression, ""}, context);
  if (!features) return features.error();
  std::vector<InputPart> parts = plain(features->parts);
  for (std::size_t f = 0; f < features->size(); ++f) {
    for (std::size_t i = features->part_begin[f]; i < features->part_begin[f + 1]; ++i)
      parts[i].radius = features->radius[f];
  }
  return parts;
}

}  // namespace

input::NetworkRequest network_request(const InputRequest& request) {
  return {request.path,   request.layer,     request.where,    request.crs,
          request.to_crs, request.arc_error, request.keep_arcs};
}

Result<std::vector<InputPart>> read_parts(const InputRequest& request, const Context& context) {
  if (!request.radius_field.empty() || !request.radius_expression.empty()) return read_parts_with_radii(request, context);
  auto source = input::open_geometry_source(request.path, {request.layer, request.where}, context);
  if (!source) return source.error();
  auto parts = read_all(**source, request.arc_error, request.keep_arcs, context);
  if (!parts) return parts.error();
  if (parts->size() == 0)
    return Error{ErrorCode::input, "has no geometry to check against", "", "give the input of the result"};

  const auto place = [&](std::int64_t number) { return (*source)->place(number); };
  if (Status plane = input::check_projection(*parts, request.to_crs, place); !plane) return plane.error();
  input::ProjectionRequest projection;
  projection.from = (*source)->crs();
  projection.to_crs = request.to_crs;
  projection.place = place;
  if (!request.crs.empty()) {
    auto assigned = ogr::parse_crs(request.crs);
    if (!assigned) return assigned.error();
    projection.from = *assigned;
  }
  std::vector<std::string> notes;  // `krepl buffer` has told them
  if (auto plane = input::project(*parts, projection, notes, context); !plane) return plane.error();
  return plain(*parts);
}

}  // namespace krepl::verify
