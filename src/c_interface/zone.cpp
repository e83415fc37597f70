#include "krepl/zone.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "c_interface/handles.hpp"
#include "c_interface/network.hpp"
#include "krepl/sweep.hpp"
#include "krepl/voronoi.hpp"

namespace ci = krepl::c_interface;

struct krepl_zone {
  krepl::Zone zone;
  std::vector<std::uint32_t> polygon_of_ring;
};

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

std::unique_ptr<krepl_zone> make_handle(krepl::Zone zone) {
  std::vector<std::uint32_t> polygon_of_ring(zone.ring_count());
  for (std::uint32_t p = 0; p < zone.polygon_count(); ++p) {
    const krepl::Zone::Polygon polygon = zone.polygon(p);
    polygon_of_ring[polygon.outer] = p;
    for (std::uint32_t hole : polygon.holes) polygon_of_ring[hole] = p;
  }
  return std::make_unique<krepl_zone>(krepl_zone{std::move(zone), std::move(polygon_of_ring)});
}

/// The caller's options, of a version that may know fewer or more members.
krepl::Result<krepl_zone_options> read_options(const krepl_zone_options* given) {
  const auto wrong = [](const char* what, const char* remedy) {
    return krepl::Error{krepl::ErrorCode::usage, what, "", remedy};
  };
  if (given == nullptr) return wrong("the options are NULL", "");
  krepl_zone_options options{};
  if (given->size < offsetof(krepl_zone_options, engine))
    return wrong("the size of the options is too small", "set it to sizeof(krepl_zone_options)");
  const char* bytes = reinterpret_cast<const char*>(given);
  for (std::size_t i = sizeof options; i < given->size; ++i) {
    if (bytes[i] != 0) return wrong("an option is set that this version of the library does not know", "leave it 0");
  }
  std::memcpy(&options, given, std::min(given->size, sizeof options));
  if (options.unused != 0) return wrong("the unused member of the options is not 0", "clear the struct first");
  if (options.engine < KREPL_ENGINE_AUTO || options.engine > KREPL_ENGINE_VORONOI)
    return wrong("the engine is unknown", "use KREPL_ENGINE_AUTO, KREPL_ENGINE_INTERVALS or KREPL_ENGINE_VORONOI");
  return options;
}

krepl::Result<std::vector<krepl::Zone>> zones_one_by_one(const krepl_network& network, bool chosen,
                                                         std::span<const double> radii, const krepl::Context& context) {
  std::vector<krepl::Zone> zones;
  for (double radius : radii) {
    auto zone = chosen ? krepl::compute_zone_auto(network.network, {radius}, context)
                       : krepl::compute_zone(network.network, {radius}, context);
    if (!zone) return zone.error();
    zones.push_back(std::move(*zone));
  }
  return zones;
}

krepl::Result<std::vector<krepl::Zone>> compute(const krepl_network& network, std::int32_t engine,
                                                std::span<const double> radii, const krepl::Context& context) {
  const bool chosen = engine == KREPL_ENGINE_AUTO;
  const bool by_diagram = chosen ? krepl::diagram_pays(*network.network, radii) : engine == KREPL_ENGINE_VORONOI;
  if (!by_diagram) return zones_one_by_one(network, chosen, radii, context);
  krepl::VoronoiOptions limits;
  if (chosen) limits.most_candidates = krepl::diagram_budget(*network.network, radii.size());
  auto diagram = krepl::VoronoiDiagram::build(network.network, context, limits);
  if (diagram) return diagram->zones(radii, context);
  if (!chosen || diagram.error().code != krepl::ErrorCode::computation) return diagram.error();
  return zones_one_by_one(network, chosen, radii, context);
}

krepl_status compute_handles(krepl_context* context, const krepl_network* network, const krepl_zone_options* options,
                             const double* radii, size_t count, krepl_zone** zones) {
  if (network == nullptr) return ci::fail(context, KREPL_ERROR_USAGE, "the network is NULL");
  if (zones == nullptr) return ci::fail(context, KREPL_ERROR_USAGE, "no place is given for the zone");
  if (radii == nullptr && count > 0) return ci::fail(context, KREPL_ERROR_USAGE, "the array of radii is NULL");
  const auto read = read_options(options);
  if (!read) return ci::fail(context, read.error());
  if (count == 0) return KREPL_OK;
  auto computed =
      compute(*network, read->engine, radii == nullptr ? std::span(&read->radius, 1) : std::span(radii, count),
              ci::settings(context));
  if (!computed) return ci::fail(context, computed.error());
  std::vector<std::unique_ptr<krepl_zone>> handles;
  for (krepl::Zone& zone : *computed) handles.push_back(make_handle(std::move(zone)));
  for (std::size_t i = 0; i < handles.size(); ++i) zones[i] = handles[i].release();
  return KREPL_OK;
}

krepl_piece piece_of(const krepl::Zone& zone, std::size_t e) {
  const krepl::Zone::Piece piece = zone.piece(static_cast<std::uint32_t>(e));
  const bool arc = piece.kind == krepl::Zone::Kind::arc;
  const krepl::Network& network = zone.network();
  const auto source = arc ? network.vertex_source(piece.source) : network.segment_source(piece.source);
  krepl_piece result{};
  result.start_x = piece.start.x;
  result.start_y = piece.start.y;
  result.end_x = piece.end.x;
  result.end_y = piece.end.y;
  result.center_x = arc ? piece.center.x : not_a_number;
  result.center_y = arc ? piece.center.y : not_a_number;
  result.radius = arc ? zone.radius() : not_a_number;
  result.feature = source.feature;
  result.part = source.part;
  result.vertex = source.vertex;
  result.kind = arc ? KREPL_ARC : KREPL_SEGMENT;
  return result;
}

krepl_ring ring_of(const krepl_zone& handle, std::size_t r) {
  const auto ring = static_cast<std::uint32_t>(r);
  krepl_ring result{};
  result.first_piece = handle.zone.ring_begin(ring);
  result.piece_count = handle.zone.ring_begin(ring + 1) - handle.zone.ring_begin(ring);
  result.polygon = handle.polygon_of_ring[r];
  result.is_hole = handle.zone.ring_is_hole(ring) ? 1 : 0;
  return result;
}

}  // namespace

krepl_status krepl_zone_compute(krepl_context* context, const krepl_network* network, const krepl_zone_options* options,
                                krepl_zone** zone) {
  if (zone != nullptr) *zone = nullptr;
  return ci::guarded(context, [&] {
    const double radius =
        options != nullptr && options->size >= offsetof(krepl_zone_options, engine) ? options->radius : 0;
    return compute_handles(context, network, options, &radius, 1, zone);
  });
}

krepl_status krepl_zone_compute_all(krepl_context* context, const krepl_network* network,
                                    const krepl_zone_options* options, const double* radii, size_t count,
                                    krepl_zone** zones) {
  if (zones != nullptr) std::fill_n(zones, count, nullptr);
  return ci::guarded(context, [&] { return compute_handles(context, network, options, radii, count, zones); });
}

void krepl_zone_destroy(krepl_zone* zone) { delete zone; }

double krepl_zone_radius(const krepl_zone* zone) { return zone == nullptr ? not_a_number : zone->zone.radius(); }
double krepl_zone_area(const krepl_zone* zone) { return zone == nullptr ? not_a_number : zone->zone.area(); }
double krepl_zone_perimeter(const krepl_zone* zone) { return zone == nullptr ? not_a_number : zone->zone.perimeter(); }
size_t krepl_zone_piece_count(const krepl_zone* zone) { return zone == nullptr ? 0 : zone->zone.piece_count(); }
size_t krepl_zone_ring_count(const krepl_zone* zone) { return zone == nullptr ? 0 : zone->zone.ring_count(); }
size_t krepl_zone_hole_count(const krepl_zone* zone) { return zone == nullptr ? 0 : zone->zone.hole_count(); }
size_t krepl_zone_polygon_count(const krepl_zone* zone) { return zone == nullptr ? 0 : zone->zone.polygon_count(); }

krepl_status krepl_zone_pieces(krepl_context* context, const krepl_zone* zone, size_t first, size_t count,
                               krepl_piece* pieces, size_t size) {
  if (zone == nullptr) return ci::fail(context, KREPL_ERROR_USAGE, "the zone is NULL");
  return ci::copy_elements(context, zone->zone.piece_count(), first, count, pieces, size,
                           [zone](std::size_t e) { return piece_of(zone->zone, e); });
}

krepl_status krepl_zone_rings(krepl_context* context, const krepl_zone* zone, size_t first, size_t count,
                              krepl_ring* rings, size_t size) {
  if (zone == nullptr) return ci::fail(context, KREPL_ERROR_USAGE, "the zone is NULL");
  return ci::copy_elements(context, zone->zone.ring_count(), first, count, rings, size,
                           [zone](std::size_t r) { return ring_of(*zone, r); });
}

krepl_status krepl_zone_check(krepl_context* context, const krepl_zone* zone) {
  return ci::guarded(context, [&]() -> krepl_status {
    if (zone == nullptr) return ci::fail(context, KREPL_ERROR_USAGE, "the zone is NULL");
    const std::optional<std::string> fault = zone->zone.validate();
    return fault ? ci::fail(context, KREPL_ERROR_INTERNAL, fault->c_str()) : KREPL_OK;
  });
}
