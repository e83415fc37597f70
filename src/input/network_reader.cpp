#include "input/network_reader.hpp"

#include <fmt/format.h>

#include "input/geometry_source.hpp"
#include "input/parts.hpp"
#include "input/projection.hpp"
#include "ogr/message_capture.hpp"
#include "ogr/spatial_reference.hpp"

namespace krepl::input {

namespace {

struct Collected {
  Parts parts;
  std::size_t with_geometry = 0, without_geometry = 0;
};

Result<Collected> collect(GeometrySource& source, double arc_error, const Context& context) {
  Collected all;
  all.parts.arc_error = arc_error;
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

Result<Network> build(const Parts& parts, const Context& context) {
  Network::Builder builder;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::span<const Point> vertices(parts.points.data() + parts.begin[i], parts.begin[i + 1] - parts.begin[i]);
    switch (parts.kind[i]) {
      case Parts::Kind::line: builder.add_line(vertices, parts.feature[i]); break;
      case Parts::Kind::ring: builder.add_ring(vertices, parts.feature[i]); break;
      case Parts::Kind::point: builder.add_point(vertices.front(), parts.feature[i]); break;
    }
  }
  return std::move(builder).build(context);
}

Result<std::optional<OGRSpatialReference>> crs_of_data(const NetworkRequest& request, const GeometrySource& source) {
  if (request.crs.empty()) return source.crs();
  Result<OGRSpatialReference> assigned = ogr::parse_crs(request.crs);
  if (!assigned) return assigned.error();
  return std::optional<OGRSpatialReference>(*assigned);
}

/// Places in the coordinate system that the data were projected to, if they were.
Result<std::vector<Point>> projected_places(const NetworkRequest& request, const std::optional<OGRSpatialReference>& from,
                                            const std::optional<OGRSpatialReference>& to, const Context& context) {
  if (request.places.empty() || request.to_crs.empty() || !to) return request.places;
  Parts parts;
  for (std::size_t i = 0; i < request.places.size(); ++i) {
    parts.points.push_back(request.places[i]);
    parts.begin.push_back(parts.points.size());
    parts.feature.push_back(std::int64_t(i) + 1);
    parts.kind.push_back(Parts::Kind::point);
  }
  std::vector<std::string> told_already;
  const auto place = [](std::int64_t number) { return "place " + std::to_string(number); };
  auto done = project(parts, {from, ogr::crs_definition(*to), place}, told_already, context);
  if (!done) return done.error();
  return parts.points;
}

}  // namespace

Result<NetworkData> read_network(const NetworkRequest& request, const Context& context) {
  auto source = open_geometry_source(request.path, {request.layer, request.where}, context);
  if (!source) return source.error();
  Result<Collected> all = collect(**source, request.arc_error, context);
  if (!all) return all.error();
  Parts& parts = all->parts;
  if (parts.size() == 0) return nothing_found(request, *all);

  NetworkData data;
  data.features = all->with_geometry;
  data.notes = (*source)->notes();
  if (all->without_geometry > 0) {
    data.notes.push_back("note: " + std::to_string(all->without_geometry) + " features without geometry are left out");
  }
  if (parts.arcs > 0) {
    data.notes.push_back(fmt::format("note: chords stand for {} arcs and deviate by {:.3g} at most; what is made of them "
                                     "is off by as much", parts.arcs, parts.arc_deviation));
  }
  if (parts.has_height) data.notes.emplace_back("note: Z and M values are left out");

  Result<std::optional<OGRSpatialReference>> crs = crs_of_data(request, **source);
  if (!crs) return crs.error();
  auto place = [&](std::int64_t number) { return (*source)->place(number); };
  Result<std::optional<OGRSpatialReference>> plane =
      project(parts, {*crs, request.to_crs, place}, data.notes, context);
  if (!plane) return plane.error();
  if (plane->has_value()) data.crs = ogr::crs_definition(**plane);
  Result<std::vector<Point>> places = projected_places(request, *crs, *plane, context);
  if (!places) return places.error();
  data.places = std::move(*places);

  Result<Network> network = build(parts, context);
  if (!network) return network.error();
  data.network = std::make_shared<const Network>(std::move(*network));
  return data;
}

}  // namespace krepl::input
