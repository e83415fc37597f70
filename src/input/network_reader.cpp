#include "input/network_reader.hpp"

#include "input/collected.hpp"
#include "input/projection.hpp"
#include "ogr/message_capture.hpp"
#include "ogr/spatial_reference.hpp"

namespace krepl::input {

namespace {

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
  Result<Collected> all = collect(**source, {request.arc_error, request.keep_arcs}, context);
  if (!all) return all.error();
  Parts& parts = all->parts;
  if (parts.size() == 0) return nothing_found(request, *all);

  NetworkData data;
  data.features = all->with_geometry;
  data.notes = notes_on(*all, **source);

  Result<std::optional<OGRSpatialReference>> crs = crs_of_data(request, **source);
  if (!crs) return crs.error();
  auto place = [&](std::int64_t number) { return (*source)->place(number); };
  if (Status plain = check_projection(parts, request.to_crs, place); !plain) return plain.error();
  Result<std::optional<OGRSpatialReference>> plane =
      project(parts, {*crs, request.to_crs, place}, data.notes, context);
  if (!plane) return plane.error();
  if (plane->has_value()) data.crs = ogr::crs_definition(**plane);
  Result<std::vector<Point>> places = projected_places(request, *crs, *plane, context);
  if (!places) return places.error();
  data.places = std::move(*places);

  if (!parts.middle.empty()) {
    auto curves = build_curve_network(parts, context);
    if (!curves) return curves.error();
    data.curves = std::make_shared<const CurveNetwork>(std::move(*curves));
    data.network = data.curves->share_straight();
    return data;
  }
  Result<Network> network = build_network(parts, context);
  if (!network) return network.error();
  data.network = std::make_shared<const Network>(std::move(*network));
  return data;
}

}  // namespace krepl::input
