#include "input/collected.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ogr/spatial_reference.hpp"

namespace krepl::input {

namespace {

/// `middles`: of the part's arcs, if the network can have some.
template <class Builder, class... Middles>
void add(Builder& builder, const Parts& parts, std::size_t i, std::int64_t feature, const Middles&... middles) {
  const std::span<const Point> vertices(parts.points.data() + parts.begin[i], parts.begin[i + 1] - parts.begin[i]);
  switch (parts.kind[i]) {
    case Parts::Kind::line: builder.add_line(vertices, middles..., feature); break;
    case Parts::Kind::ring: builder.add_ring(vertices, middles..., feature); break;
    case Parts::Kind::point: builder.add_point(vertices.front(), feature); break;
  }
}

}  // namespace

Result<Collected> collect(GeometrySource& source, const ArcTreatment& arcs, const Context& context, const Seen& seen) {
  Collected all;
  all.parts.arc_error = arcs.error;
  all.parts.keep_arcs = arcs.keep;
  for (std::size_t count = 0;; ++count) {
    if (context.cancelled()) return Error{ErrorCode::cancelled, "interrupted while reading", "", ""};
    if (context.progress && count % 256 == 0) context.progress(source.fraction());
    auto item = source.next();
    if (!item) return item.error();
    if (!item->has_value()) break;
    const GeometrySource::Item& record = **item;
    if (record.geometry == nullptr || record.geometry->IsEmpty()) {
      ++all.without_geometry;
      continue;
    }
    ++all.with_geometry;
    Status added = all.parts.add(*record.geometry, record.number, source.place(record.number));
    if (!added) return added.error();
    if (seen) seen(record, all.parts.size());
  }
  return all;
}

Error nothing_found(const NetworkRequest& request, const Collected& found) {
  if (!request.where.empty() && found.without_geometry == 0) {
    return {ErrorCode::input, "no feature satisfies --where '" + request.where + "'", "", "check the condition"};
  }
  if (found.without_geometry > 0) {
    return {ErrorCode::input, "all features have an empty geometry", "", "give lines, polygons or points"};
  }
  return {ErrorCode::input, "has no features", "", "give lines, polygons or points"};
}

std::vector<std::string> notes_on(const Collected& all, const GeometrySource& source) {
  std::vector<std::string> notes = source.notes();
  if (all.without_geometry > 0) {
    notes.push_back("note: " + std::to_string(all.without_geometry) + " features without geometry are left out");
  }
  if (all.parts.arcs > 0) {
    notes.push_back(fmt::format("note: chords stand for {} arcs and deviate by {:.3g} at most; what is made of them "
                                "is off by as much", all.parts.arcs, all.parts.arc_deviation));
  }
  if (all.parts.has_height) notes.emplace_back("note: Z and M values are left out");
  return notes;
}

Result<std::optional<OGRSpatialReference>> crs_of_data(const NetworkRequest& request, const GeometrySource& source) {
  if (request.crs.empty()) return source.crs();
  Result<OGRSpatialReference> assigned = ogr::parse_crs(request.crs);
  if (!assigned) return assigned.error();
  return std::optional<OGRSpatialReference>(*assigned);
}

void add_part(Network::Builder& builder, const Parts& parts, std::size_t i, std::int64_t feature) {
  add(builder, parts, i, feature);
}

void add_part(CurveNetwork::Builder& builder, const Parts& parts, std::size_t i, std::int64_t feature) {
  add(builder, parts, i, feature, parts.middles_of(i));
}

Result<Network> build_network(const Parts& parts, const Context& context) {
  Network::Builder builder;
  for (std::size_t i = 0; i < parts.size(); ++i) add_part(builder, parts, i, parts.feature[i]);
  return std::move(builder).build(context);
}

Result<CurveNetwork> build_curve_network(const Parts& parts, const Context& context) {
  CurveNetwork::Builder builder;
  for (std::size_t i = 0; i < parts.size(); ++i) add_part(builder, parts, i, parts.feature[i]);
  return std::move(builder).build(context);
}

Status check_projection(const Parts& parts, const std::string& to_crs,
                        const std::function<std::string(std::int64_t)>& place) {
  if (to_crs.empty() || parts.middle.empty()) return std::monostate{};
  const auto after = std::upper_bound(parts.begin.begin(), parts.begin.end(), parts.middle.front());
  return Error{ErrorCode::input, "arcs cannot be projected",
               place(parts.feature[static_cast<std::size_t>(after - parts.begin.begin()) - 1]),
               "give --arc-error LENGTH for chords in their place that deviate by no more"};
}

}  // namespace krepl::input
