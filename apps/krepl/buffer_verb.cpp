#include <fmt/format.h>

#include <algorithm>

#include "input/network_reader.hpp"
#include "krepl/curve_zone.hpp"
#include "krepl/sweep.hpp"
#include "krepl/voronoi.hpp"
#include "krepl/zone.hpp"
#include "output/zone_file.hpp"
#include "feature_buffer.hpp"
#include "network_options.hpp"
#include "output_target.hpp"
#include "shape_options.hpp"
#include "stopwatch.hpp"
#include "verbs.hpp"

namespace krepl::app {

namespace {

struct BufferOptions {
  input::NetworkRequest input;
  std::string output, radius, max_error, format, engine = "auto";
  bool no_pieces = false, separate = false, bands = false;
  ShapeArguments shape;
  FeatureOptions features;
};

/// What the options mean once they are checked; made before anything is read.
struct BufferPlan {
  std::vector<double> radii;
  std::string engine;
  ShapeOptions shape;
  output::ZoneFormat format;
  output::ZoneFileOptions file;
};

Status check_engine(const std::string& engine) {
  if (engine == "auto" || engine == "intervals" || engine == "voronoi" || engine == "sweep") return std::monostate{};
  return Error{ErrorCode::usage, "engine '" + engine + "' is unknown", "",
               "give --engine auto, intervals, voronoi or sweep"};
}

bool wants_diagram(const std::string& engine, const std::vector<double>& radii, const Network& network) {
  return engine == "auto" ? diagram_pays(network, radii) : engine == "voronoi";
}

Status check_bands(const BufferOptions& options, const BufferPlan& plan) {
  const auto usage = [](const char* what, const char* remedy) { return Error{ErrorCode::usage, what, "", remedy}; };
  if (needs_features(options.features, options.radius))
    return usage("--bands does not go with radii or zones of single features", "leave one of them out");
  if (!is_plain(plan.shape, plan.radii))
    return usage("bands have round caps and joins, both sides and positive radii", "leave the other options out");
  return std::monostate{};
}

Result<BufferPlan> make_plan(const BufferOptions& options) {
  BufferPlan plan;
  if (Status engine = check_engine(options.engine); !engine) return engine.error();
  if (!needs_features(options.features, options.radius)) {
    Result<std::vector<double>> radii = parse_signed_radii(options.radius);
    if (!radii) return radii.error();
    plan.radii = *radii;
  }
  Result<ShapeOptions> shape = parse_shape(options.shape);
  if (!shape) return shape.error();
  plan.shape = *shape;
  if (!is_plain(plan.shape, plan.radii)) {
    if (options.engine == "voronoi" || options.engine == "sweep")
      return Error{ErrorCode::usage, "--engine " + options.engine + " makes whole round zones only", "", "leave --engine out"};
  }
  plan.engine = options.engine;
  if (!options.max_error.empty()) {
    Result<double> max_error = parse_positive("--max-error", options.max_error);
    if (!max_error) return max_error.error();
    plan.file.max_error = *max_error;
    plan.shape.max_error = *max_error;
  }
  Result<output::ZoneFormat> format = output::find_zone_format(options.output, options.format);
  if (!format) return Error{format.error().code, options.output + ": " + format.error().what, "", format.error().remedy};
  plan.format = *format;
  plan.file.pieces = !options.no_pieces;
  plan.file.separate = options.separate;
  plan.file.bands = options.bands;
  if (options.bands) {
    if (Status possible = check_bands(options, plan); !possible) return possible.error();
    std::sort(plan.radii.begin(), plan.radii.end());
  }
  return plan;
}

void tell_cleaning(const input::NetworkData& data, double seconds, Session& session) {
  const CleaningReport& report = data.network->report();
  session.detail(fmt::format("read       {:.3f} s: {} features, {} vertices ({} distinct), {} segments", seconds,
                             data.features, report.input_vertices, data.network->vertices().size(),
                             data.network->segments().size()));
  if (data.curves) session.detail(fmt::format("arcs       {}", data.curves->arcs().size()));
  session.detail(fmt::format("cleaning   {} coinciding vertices welded, {} repeated vertices and {} duplicate segments dropped",
                             report.coinciding_vertices, report.repeated_vertices, report.duplicate_segments));
}

void tell_counters(const Zone& zone, double seconds, Session& session) {
  const ZoneCounters& c = zone.counters();
  session.detail(fmt::format("zone       {:.3f} s: radius {}, {} pieces, {} rings ({} holes), {} polygons", seconds,
                             zone.radius(), zone.piece_count(), zone.ring_count(), zone.hole_count(), zone.polygon_count()));
  if (c.elements == 0) return;
  session.detail(fmt::format("elements   {} examined, {} covered at once, {} cigars met", c.elements, c.covered_at_once,
                             c.candidates));
  session.detail(fmt::format("predicates {} decided in double precision, {} in quadruple, {} ties by perturbation",
                             c.elements_in_double, c.elements_in_quadruple, c.ties_by_perturbation));
  session.detail(fmt::format("resolution {} pieces collapsed, {} rings dropped", c.collapsed_pieces, c.dropped_rings));
}

void tell_diagram(const VoronoiDiagram& diagram, double seconds, Session& session) {
  const VoronoiCounters& c = diagram.counters();
  session.detail(fmt::format("diagram    {:.3f} s: {} faces, {} edges, {} vertices", seconds, c.faces,
                             diagram.edge_count(), diagram.vertex_count()));
  session.detail(fmt::format("faces      {} candidates; {} done again in pairs of doubles, {} in quadruple precision, {} in 320 bits; {} vertices, {} links reconciled", c.candidates, c.faces_in_pairs, c.faces_in_quadruple, c.faces_in_320_bits, c.vertices_in_quadruple, c.links_reconciled));
}

void tell_sweep(const SweepCounters& c, Session& session) {
  session.detail(fmt::format("sweep      {} paths, {} rounds, {} curves, {} crossings", c.paths, c.rounds, c.curves, c.crossings));
  session.detail(fmt::format("predicates {} decided in double precision, {} in quadruple, {} in 320 bits, {} ties by name",
                             c.decisions - c.decided_in_quadruple - c.decided_in_320_bits, c.decided_in_quadruple, c.decided_in_320_bits, c.ties));
}

Result<Zone> zone_by_either(const input::NetworkData& data, double radius, Session& session) {
  AutoCounters counters;
  Result<Zone> zone = compute_zone_auto(data.network, {radius}, session.context("computing"), &counters);
  if (!counters.given_up.empty()) session.detail("intervals  given up: " + counters.given_up);
  if (counters.by_sweep) tell_sweep(counters.sweep, session);
  return zone;
}

Result<Zone> zone_without_diagram(const input::NetworkData& data, const BufferPlan& plan, double radius, Session& session) {
  if (plan.engine == "auto") return zone_by_either(data, radius, session);
  if (plan.engine != "sweep") return compute_zone(data.network, {radius}, session.context("computing"));
  SweepCounters counters;
  Result<Zone> zone = compute_zone_by_sweep(data.network, {radius}, session.context("computing"), &counters);
  tell_sweep(counters, session);
  return zone;
}

std::string summary_line(const Network& network, const std::vector<Zone>& zones, double seconds) {
  std::string text = fmt::format("{} segments", network.segments().size());
  if (zones.front().curves() != nullptr) text += fmt::format(", {} arcs", zones.front().curves()->arcs().size());
  for (const Zone& zone : zones) {
    std::size_t arcs = 0;
    for (std::uint32_t e = 0; e < zone.piece_count(); ++e) arcs += zone.piece(e).kind == Zone::Kind::arc ? 1 : 0;
    const std::string inner = zone.inner_radius() > 0 ? fmt::format("{} to ", zone.inner_radius()) : "";
    text += fmt::format("; radius {}: {} rings, {} holes, {} arcs, area {:.10g}", inner + fmt::format("{}", zone.signed_radius()), zone.ring_count(),
                        zone.hole_count(), arcs, zone.area());
  }
  return text + fmt::format("; {:.3f} s", seconds);
}

Result<std::vector<Zone>> zones_from_diagram(const input::NetworkData& data, const BufferPlan& plan, Session& session) {
  Stopwatch watch;
  VoronoiOptions limits;
  if (plan.engine == "auto") limits.most_candidates = diagram_budget(*data.network, plan.radii.size());
  const Result<VoronoiDiagram> diagram = VoronoiDiagram::build(data.network, session.context("diagram"), limits);
  if (!diagram) return diagram.error();
  tell_diagram(*diagram, watch.seconds(), session);
  Stopwatch extracting;
  Result<std::vector<Zone>> zones = diagram->zones(plan.radii, session.context("computing"));
  if (!zones) return zones.error();
  const double each = extracting.seconds() / double(zones->size());
  for (const Zone& zone : *zones) tell_counters(zone, each, session);
  return zones;
}

Result<std::vector<Zone>> zones_of_curves(const input::NetworkData& data, const BufferPlan& plan, Session& session) {
  std::vector<Zone> zones;
  for (double radius : plan.radii) {
    Stopwatch watch;
    Result<Zone> zone = compute_zone(data.curves, {radius}, session.context("computing"));
    if (!zone) return zone.error();
    tell_counters(*zone, watch.seconds(), session);
    zones.push_back(std::move(*zone));
  }
  return zones;
}

Result<std::vector<Zone>> compute_zones(const input::NetworkData& data, const BufferPlan& plan, Session& session) {
  if (data.curves) return zones_of_curves(data, plan, session);
  if (wants_diagram(plan.engine, plan.radii, *data.network)) {
    Result<std::vector<Zone>> zones = zones_from_diagram(data, plan, session);
    if (zones.ok() || plan.engine == "voronoi" || zones.error().code != ErrorCode::computation) return zones;
    session.detail("diagram    given up: " + zones.error().text());  // auto: the other engines need none
  }
  std::vector<Zone> zones;
  for (double radius : plan.radii) {
    Stopwatch watch;
    Result<Zone> zone = zone_without_diagram(data, plan, radius, session);
    if (!zone) return zone.error();
    tell_counters(*zone, watch.seconds(), session);
    zones.push_back(std::move(*zone));
  }
  return zones;
}

/// In place of each zone but the first, what it adds to the one before.
Result<std::vector<Zone>> bands_of(const std::vector<Zone>& zones, Session& session) {
  std::vector<Zone> bands{zones.front()};
  for (std::size_t i = 1; i < zones.size(); ++i) {
    Result<Zone> band = zone_band(zones[i - 1], zones[i], session.context("bands"));
    if (!band) return band.error();
    bands.push_back(std::move(*band));
  }
  return bands;
}

int run_buffer(const BufferOptions& options, Session& session) {
  Stopwatch total;
  Result<BufferPlan> plan = make_plan(options);
  if (!plan) return session.fail("", plan.error());
  if (Status target = check_target(options.output, {options.input.path}); !target)
    return session.fail(options.output, target.error());
  if (needs_features(options.features, options.radius)) {
    return run_feature_buffer({options.features, options.input, options.output, options.radius, options.engine, plan->format,
                               plan->file, plan->shape},
                              session);
  }

  Stopwatch reading;
  const std::string in_name = input_name(options.input.path);
  input::NetworkRequest request = options.input;
  request.keep_arcs = takes_arcs(plan->shape) && plan->engine == "auto";
  Result<input::NetworkData> data = input::read_network(request, session.context("reading"));
  if (!data) return session.fail(in_name, data.error());
  for (const std::string& note : data->notes) session.note(in_name, note);
  tell_cleaning(*data, reading.seconds(), session);

  Result<std::vector<Zone>> zones =
      is_plain(plan->shape, plan->radii) ? compute_zones(*data, *plan, session)
                                         : shaped_zones(*data, plan->radii, plan->shape, in_name, session);
  if (zones.ok() && plan->file.bands) zones = bands_of(*zones, session);
  if (!zones) return session.fail(in_name, zones.error());

  Stopwatch writing;
  const std::string out_name = output_name(options.output);
  plan->file.crs = data->crs;
  auto report = output::write_zones(options.output, *zones, plan->format, plan->file, session.context("writing"));
  if (!report) return session.fail(out_name, report.error());
  for (const std::string& note : report->notes) session.note(out_name, note);
  if (report->deviation) {
    session.note(out_name, fmt::format("note: {} has no arcs; the polygons deviate from the true zone by {:.6g} at most",
                                       plan->format.name, *report->deviation));
  }
  session.detail(fmt::format("write      {:.3f} s", writing.seconds()));
  session.summary(summary_line(*data->network, *zones, total.seconds()), options.output == "-");
  return 0;
}

}  // namespace

void add_buffer_verb(Verb& program, Session& session) {
  auto options = std::make_shared<BufferOptions>();
  Verb verb = program.add_verb(
      "buffer", "Buffer zone of lines, polygons and points, bounded by true arcs");
  verb.add_option("IN", options->input.path, "Vector file: any OGR format, .wkt (a geometry a line), .wkb, .gz of them, or -")
      .required();
  verb.add_option("OUT", options->output,
                  "Result: .gpkg .fgb .wkt .wkb (curves), .svg .dxf (arcs), .geojson .shp ... (chords), or -")
      .required();
  verb.add_option("--radius", options->radius,
                  "Radius of the disk, in the unit of the coordinates; several, or FIRST:LAST:STEP, give nested zones; "
                  "negative: polygons are shrunk; or an expression of fields, a radius for each feature: \"width / 2 + 5\"")
      .type_name("R[,R2,...]");
  add_feature_options(verb, options->features);
  add_network_options(verb, options->input, options->format);
  add_shape_options(verb, options->shape);
  verb.add_option("--max-error", options->max_error, "Formats without arcs: largest deviation (default: radius / 1000)")
      .type_name("LENGTH");
  verb.add_flag("--bands", options->bands,
                "Several radii: the bands between them, each zone less the one before (field inner: where a band begins)");
  verb.add_flag("--separate", options->separate, "A feature for each polygon, not for each radius");
  verb.add_flag("--no-pieces", options->no_pieces, "GeoPackage: no layer of boundary pieces with their origin");
  verb.add_option("--engine", options->engine, "Algorithm: auto, intervals, voronoi, sweep").type_name("NAME");
  session.add_common_options(verb);
  session.on_run(verb, [options, &session] { return run_buffer(*options, session); });
}

}  // namespace krepl::app
