// krepl info: what a result is like.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "input/geometry_source.hpp"
#include "input/profile_reader.hpp"
#include "input/result_file.hpp"
#include "input/subdivision_file.hpp"
#include "measure/surface_measure.hpp"
#include "measure/zone_measure.hpp"
#include "output/output_stream.hpp"
#include "verbs.hpp"

namespace krepl::app {

namespace {

using Json = nlohmann::ordered_json;
using measure::Placed;
using measure::SurfaceMeasure;

struct InfoOptions {
  std::string result;
  bool json = false;
};

constexpr double promised = 1e-9;  // of S, as docs/robustness.md has it
constexpr double degrees = 180 / std::numbers::pi;

std::string place(Point3 p) { return fmt::format("{:.9g} {:.9g} {:.9g}", p.x, p.y, p.z); }
Json json_place(Point3 p) { return Json::array({p.x, p.y, p.z}); }
Json json_of(const Placed& placed, double factor = 1) {
  if (!placed.found) return nullptr;
  return {{"value", factor * placed.value}, {"at", json_place(placed.at)}};
}
Json json_of(const measure::PlacedInPlane& placed) {
  if (!placed.found) return nullptr;
  return {{"value", placed.value}, {"at", Json::array({placed.at.x, placed.at.y})}};
}

constexpr const char* face_names[] = {"spheres", "cylinders", "planes"};
constexpr const char* edge_names[] = {"seams", "valleys", "rims"};
constexpr const char* curve_names[] = {"lines", "circles", "ellipses", "quartics"};

void print_row(Session& session, std::string_view name, std::size_t count, double value) {
  session.summary(fmt::format("  {:<18} {:>10} {:>18.10g}", name, count, value));
}

void print_valleys(Session& session, const measure::Valleys& valleys) {
  if (valleys.count == 0) return;
  session.summary(fmt::format("    sharpest: a turn of {:.4g} degrees at {}", degrees * valleys.turn.value,
                              place(valleys.turn.at)));
}

void print_reach(Session& session, const SurfaceMeasure& m) {
  session.summary("where the ball touches two places");
  print_row(session, "inner edges", m.creases.count, m.creases.length);
  print_valleys(session, m.creases);
  if (m.creases.count > 0)
    session.summary(
        fmt::format("    most left in the edge: {:.6g} at {}", m.creases.depth.value, place(m.creases.depth.at)));
  print_row(session, "bridges", m.bridges.count, m.bridges.length);
  print_valleys(session, m.bridges);
  if (m.bridges.count == 0) return;
  session.summary(fmt::format("    narrowest: only a ball of radius below {:.6g} gets between, at {}",
                              m.narrowest_bridge.value, place(m.narrowest_bridge.at)));
  session.summary(fmt::format("    widest: only a ball of radius below {:.6g} gets between, at {}",
                              m.widest_bridge.value, place(m.widest_bridge.at)));
}

void print(Session& session, const SurfaceMeasure& m) {
  session.summary(fmt::format("surface of radius {}: {} vertices, {} edges, {} faces, {} holes", m.radius, m.vertices,
                              m.edges, m.faces, m.holes));
  session.summary(fmt::format("from {} to {}", place(m.lowest), place(m.highest)));
  session.summary(fmt::format("{:<20} {:>10} {:>18} {:>18}", "faces", "count", "area", "seen from above"));
  SurfaceMeasure::Faces all;
  for (const std::size_t kind : {2, 1, 0}) {
    const SurfaceMeasure::Faces& found = m.by_feature[kind];
    session.summary(fmt::format("  {:<18} {:>10} {:>18.10g} {:>18.10g}", face_names[kind], found.count, found.area,
                                found.projected));
    all.count += found.count, all.area += found.area, all.projected += found.projected;
  }
  session.summary(fmt::format("  {:<18} {:>10} {:>18.10g} {:>18.10g}", "all", all.count, all.area, all.projected));
  session.summary(fmt::format("{:<20} {:>10} {:>18}", "edges", "count", "length"));
  for (std::size_t kind = 0; kind < 3; ++kind)
    print_row(session, edge_names[kind], m.by_kind[kind].count, m.by_kind[kind].length);
  session.summary(fmt::format("{:<20} {:>10} {:>18}", "curves", "count", "length"));
  for (std::size_t c = 0; c < 4; ++c) print_row(session, curve_names[c], m.by_curve[c].count, m.by_curve[c].length);
  print_reach(session, m);
  session.summary(fmt::format("shortest edge {:.4g} at {}", m.shortest_edge.value, place(m.shortest_edge.at)));
  session.summary(fmt::format("smallest face {:.4g} at {}", m.smallest_face.value, place(m.smallest_face.at)));
  session.summary(fmt::format(
      "accuracy: the ball is within {:.3g} of what it touches along every edge, at worst at {}; promised {:.3g}",
      m.residual.value, place(m.residual.at), promised * m.scale));
}

Json json_of(const measure::Valleys& valleys) {
  return {
      {"count", valleys.count}, {"length", valleys.length}, {"sharpest_turn_degrees", json_of(valleys.turn, degrees)}};
}

Json json_of(const SurfaceMeasure& m) {
  Json json{{"krepl", "info"},
            {"of", "surface"},
            {"radius", m.radius},
            {"vertices", m.vertices},
            {"edges", m.edges},
            {"faces", m.faces},
            {"holes", m.holes},
            {"from", json_place(m.lowest)},
            {"to", json_place(m.highest)}};
  double area = 0, projected = 0;
  for (const std::size_t kind : {2, 1, 0}) {
    const SurfaceMeasure::Faces& found = m.by_feature[kind];
    json["faces_by_kind"][face_names[kind]] = {
        {"count", found.count}, {"area", found.area}, {"projected_area", found.projected}};
    area += found.area, projected += found.projected;
  }
  json["area"] = area, json["projected_area"] = projected;
  for (std::size_t k = 0; k < 3; ++k)
    json["edges_by_kind"][edge_names[k]] = {{"count", m.by_kind[k].count}, {"length", m.by_kind[k].length}};
  for (std::size_t c = 0; c < 4; ++c)
    json["edges_by_curve"][curve_names[c]] = {{"count", m.by_curve[c].count}, {"length", m.by_curve[c].length}};
  json["inner_edges"] = json_of(m.creases);
  json["inner_edges"]["most_left"] = json_of(m.creases.depth);
  json["bridges"] = json_of(m.bridges);
  json["bridges"]["narrowest_radius"] = json_of(m.narrowest_bridge);
  json["bridges"]["widest_radius"] = json_of(m.widest_bridge);
  json["shortest_edge"] = json_of(m.shortest_edge), json["smallest_face"] = json_of(m.smallest_face);
  json["accuracy"] = {{"promised", promised * m.scale}, {"found", json_of(m.residual)}};
  return json;
}

void print(Session& session, const measure::ZoneMeasure& m) {
  session.summary(fmt::format("zone of radius {}: {} polygons, {} holes, area {:.12g}",
                              m.radius ? fmt::format("{}", *m.radius) : "unknown", m.polygons, m.holes, m.area));
  session.summary(fmt::format("{:<20} {:>10} {:>18}", "boundary", "pieces", "length"));
  print_row(session, "segments", m.segments, m.segment_length);
  print_row(session, "arcs", m.arcs, m.arc_length);
  const auto smallest = [&](const char* name, const measure::PlacedInPlane& p) {
    if (p.found) session.summary(fmt::format("{} {:.4g} at {:.12g} {:.12g}", name, p.value, p.at.x, p.at.y));
  };
  smallest("shortest piece", m.shortest_piece);
  smallest("smallest polygon", m.smallest_polygon);
  smallest("smallest hole", m.smallest_hole);
}

Json json_of(const measure::ZoneMeasure& m) {
  return {{"radius", m.radius ? Json(*m.radius) : Json(nullptr)},
          {"polygons", m.polygons},
          {"holes", m.holes},
          {"area", m.area},
          {"length", m.length},
          {"segments", {{"count", m.segments}, {"length", m.segment_length}}},
          {"arcs", {{"count", m.arcs}, {"length", m.arc_length}}},
          {"shortest_piece", json_of(m.shortest_piece)},
          {"smallest_polygon", json_of(m.smallest_polygon)},
          {"smallest_hole", json_of(m.smallest_hole)}};
}

/// The result itself: it goes to standard output, --quiet or not.
int put(const Json& json, Session& session) {
  Result<output::OutputStream> stream = output::OutputStream::open("-");
  if (!stream) return session.fail("", stream.error());
  stream->write(json.dump(2) + "\n");
  if (Status finished = stream->finish(); !finished) return session.fail("standard output", finished.error());
  return 0;
}

int tell_surface(const InfoOptions& options, Result<input::SubdivisionFile> file, Session& session) {
  session.finish_progress();
  if (!file) return session.fail(options.result, file.error());
  const Result<SurfaceMeasure> measured = measure::measure_surface(*file, session.context("measuring"));
  session.finish_progress();
  if (!measured) return session.fail(options.result, measured.error());
  if (options.json) return put(json_of(*measured), session);
  print(session, *measured);
  return 0;
}

int tell_profile(const InfoOptions& options, Session& session) {
  const auto pieces = input::read_profile(options.result);
  if (!pieces) return session.fail(options.result, pieces.error());
  const measure::ProfileMeasure m = measure::measure_profile(*pieces);
  if (options.json) {
    return put({{"krepl", "info"},
                {"of", "profile"},
                {"segments", {{"count", m.segments}, {"length", m.segment_length}}},
                {"arcs", {{"count", m.arcs}, {"length", m.arc_length}}},
                {"lowest", m.lowest},
                {"highest", m.highest},
                {"shortest_piece", json_of(m.shortest_piece)}},
               session);
  }
  session.summary(fmt::format("profile: {} pieces, heights {:.12g} to {:.12g}", pieces->size(), m.lowest, m.highest));
  session.summary(fmt::format("{:<20} {:>10} {:>18}", "boundary", "pieces", "length"));
  print_row(session, "segments", m.segments, m.segment_length);
  print_row(session, "arcs", m.arcs, m.arc_length);
  return 0;
}

int tell_zones(const InfoOptions& options, Session& session) {
  const auto zones = input::read_zones(options.result);
  if (!zones) return session.fail(options.result, zones.error());
  Json json{{"krepl", "info"}, {"of", "zones"}, {"zones", Json::array()}};
  for (const input::ResultZone& zone : *zones) {
    const measure::ZoneMeasure measured = measure::measure_zone(zone);
    if (options.json)
      json["zones"].push_back(json_of(measured));
    else
      print(session, measured);
  }
  return options.json ? put(json, session) : 0;
}

int run_info(const InfoOptions& options, Session& session) {
  const std::string extension = input::format_extension(options.result);
  if (extension == "json" && input::looks_like_subdivision(options.result))
    return tell_surface(options, input::read_subdivision(options.result, session.context("reading")), session);
  if (extension == "gpkg" && input::is_subdivision_gpkg(options.result)) {
    auto layers = input::read_subdivision_gpkg(options.result, session.context("reading"));
    if (!layers) return tell_surface(options, layers.error(), session);
    return tell_surface(options, std::move(layers->file), session);
  }
  return extension == "csv" ? tell_profile(options, session) : tell_zones(options, session);
}

}  // namespace

void add_info_verb(Verb& program, Session& session) {
  auto options = std::make_shared<InfoOptions>();
  Verb verb =
      program.add_verb("info", "What a result is like: counts, areas, lengths, the smallest, the sharpest");
  verb.add_option("RESULT", options->result, "Surface (.json, .gpkg), zone (vector file) or profile (.csv)")
      .required();
  verb.add_flag("--json", options->json, "Print JSON, with all digits");
  session.add_common_options(verb);
  session.on_run(verb, [options, &session] { return run_info(*options, session); });
}

}  // namespace krepl::app
