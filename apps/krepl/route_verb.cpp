// krepl route: collision-free ways of a disk among obstacles, and of a ball over a terrain.
#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "input/network_reader.hpp"
#include "krepl/route.hpp"
#include "network_options.hpp"
#include "output/route_file.hpp"
#include "output_target.hpp"
#include "route_options.hpp"
#include "stopwatch.hpp"
#include "verbs.hpp"

namespace krepl::app {

namespace {

/// What the options mean in the plane.
struct PlanePlan {
  RouteOptions route;
  output::RouteFormat format;
  output::RouteFileOptions file;
};

Status read_preference(const std::string& text, RouteOptions& route) {
  if (text.empty() || text == "length") return std::monostate{};
  if (text == "clearance") {
    route.prefer = RoutePreference::clearance;
    return std::monostate{};
  }
  const auto [last, status] = std::from_chars(text.data(), text.data() + text.size(), route.weight);
  if (status != std::errc{} || last != text.data() + text.size() || !(route.weight >= 0 && route.weight <= 1))
    return Error{ErrorCode::usage, "--prefer '" + text + "' is neither length, nor clearance, nor a number in 0 .. 1",
                 "", "0 is the shortest route, 1 the shortest of the widest"};
  return std::monostate{};
}

/// What is for terrains only, if it is given.
std::optional<Error> refuse_terrain_options(const RouteVerbOptions& options) {
  for (const auto& [name, text] : {std::pair{"--ceiling", &options.ceiling}, std::pair{"--max-slope", &options.max_slope},
                                   std::pair{"--minimise", &options.minimise}, std::pair{"--step", &options.step}})
    if (!text->empty()) return for_terrains_only(name);
  if (const char* name = options.terrain.given_reading_option()) return for_terrains_only(name);
  return std::nullopt;
}

Result<PlanePlan> make_plan(const RouteVerbOptions& options) {
  PlanePlan plan;
  if (const auto error = refuse_terrain_options(options)) return *error;
  const Result<double> radius = parse_radius(options.radius);
  if (!radius) return radius.error();
  plan.route.radius = *radius;
  for (const auto& [name, text, place] :
       {std::tuple{"--from", &options.from, &plan.route.from}, std::tuple{"--to", &options.to, &plan.route.to}}) {
    const Result<std::vector<double>> numbers = parse_place(name, *text);
    if (!numbers) return numbers.error();
    if (numbers->size() != 2)
      return Error{ErrorCode::usage, fmt::format("{} '{}' has three coordinates, but IN is flat", name, *text), "",
                   "give x,y"};
    *place = {(*numbers)[0], (*numbers)[1]};
  }
  if (Status preference = read_preference(options.prefer, plan.route); !preference) return preference.error();
  if (!options.max_error.empty()) {
    const Result<double> max_error = parse_positive("--max-error", options.max_error);
    if (!max_error) return max_error.error();
    plan.file.max_error = *max_error;
  }
  Result<output::RouteFormat> format = output::find_route_format(options.output, options.format);
  if (!format)
    return Error{format.error().code, options.output + ": " + format.error().what, "", format.error().remedy};
  plan.format = *format;
  return plan;
}

std::string pieces_text(const Route& route) {
  std::size_t lines = 0, arcs = 0, parabolas = 0;
  for (const Route::Piece& piece : route.pieces)
    ++(piece.kind == Route::Kind::line ? lines : piece.kind == Route::Kind::arc ? arcs : parabolas);
  return fmt::format("{} lines, {} arcs{}", lines, arcs, parabolas > 0 ? fmt::format(", {} parabolas", parabolas) : "");
}

}  // namespace

int run_plane_route(const RouteVerbOptions& options, Session& session) {
  const Stopwatch total;
  Result<PlanePlan> plan = make_plan(options);
  if (!plan) return session.fail("", plan.error());
  if (Status target = check_target(options.output, {options.input.path}); !target)
    return session.fail(options.output, target.error());
  const std::string in_name = input_name(options.input.path), out_name = output_name(options.output);
  input::NetworkRequest request = options.input;
  request.places = {plan->route.from, plan->route.to};
  const Result<input::NetworkData> data = input::read_network(request, session.context("reading"));
  if (!data) return session.fail(in_name, data.error());
  for (const std::string& note : data->notes) session.note(in_name, note);
  plan->route.from = data->places[0], plan->route.to = data->places[1];

  const Stopwatch searching;
  const Result<Route> route = compute_route(data->network, plan->route, session.context("searching"));
  if (!route) return session.fail(in_name, route.error());
  const RouteCounters& c = route->counters;
  session.detail(fmt::format("search     {:.3f} s: {} arcs, {} arrivals, {} tangents, {} tested for visibility",
                             searching.seconds(), c.arcs, c.arrivals, c.tangents, c.visibility_tests));

  std::optional<Zone> zone;
  if (!plan->format.csv && plan->format.curves.kind == output::ZoneFormat::Kind::svg) {
    Result<Zone> made = compute_zone(data->network, {plan->route.radius}, session.context("drawing"));
    if (!made) return session.fail(in_name, made.error());
    zone.emplace(std::move(*made));
  }
  plan->file.crs = data->crs;
  const auto report = output::write_route(options.output, *route, *data->network, zone ? &*zone : nullptr, plan->format,
                                          plan->file, session.context("writing"));
  if (!report) return session.fail(out_name, report.error());
  for (const std::string& note : report->notes) session.note(out_name, note);
  if (report->deviation && *report->deviation > 0)
    session.note(
        out_name,
        fmt::format("note: chords deviate from the true route by {:.6g} at most; clearance may be less by that",
                    *report->deviation));
  session.summary(fmt::format("length {:.10g}, clearance {:.10g}{}; {}; {:.3f} s", route->length, route->clearance,
                              route->widest > 0 ? fmt::format(" (widest {:.10g})", route->widest) : "",
                              pieces_text(*route), total.seconds()),
                  options.output == "-");
  return 0;
}

Result<std::vector<double>> parse_place(std::string_view option, std::string_view text) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view one = text.substr(begin, end - begin), digits = one.starts_with('+') ? one.substr(1) : one;
    double value = 0;
    const auto [last, status] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (status != std::errc{} || last != digits.data() + digits.size() || !std::isfinite(value)) numbers.resize(4);
    numbers.push_back(value);
    begin = end + 1;
  }
  if (numbers.size() != 2 && numbers.size() != 3)
    return Error{ErrorCode::usage, fmt::format("{} '{}' is not a place", option, text), "",
                 "give two coordinates, x,y, or over a terrain three, x,y,z"};
  return numbers;
}

namespace {

void add_plane_options(Verb& verb, RouteVerbOptions& options) {
  verb.add_option(
          "--prefer", options.prefer,
          "Plane: length, the shortest route (default); clearance, the widest along the medial axis; W in 0 .. 1, the "
          "shortest with clearance of at least R + W (widest - R)")
      .type_name("WHAT");
  verb.add_option(
          "--max-error", options.max_error,
          "Plane: largest deviation of chords where a format has no arcs, and for parabolas (default: R / 1000)")
      .type_name("LENGTH");
}

void add_flight_options(Verb& verb, RouteVerbOptions& options) {
  verb.add_option("--ceiling", options.ceiling, "Terrain: the ball's centre stays at or below this height")
      .type_name("Z");
  verb.add_option("--max-slope", options.max_slope,
                  "Terrain: largest rise over horizontal way, up and down: 0.2 is 20 %")
      .type_name("SLOPE");
  verb.add_option("--minimise", options.minimise, "Terrain: length (default) or climb, the sum of all rises")
      .type_name("WHAT");
  verb.add_option("--step", options.step, "Terrain: distance of the lattice that is searched (default: by the extent)")
      .type_name("LENGTH");
  add_reading_options(verb, options.terrain, "Terrain");
}

}  // namespace

void add_route_verb(Verb& program, Session& session) {
  auto options = std::make_shared<RouteVerbOptions>();
  Verb verb = program.add_verb(
      "route", "Collision-free route of a disk among lines, polygons and points, or of a ball over a terrain");
  verb.add_option(
          "IN", options->input.path,
          "Obstacles: any OGR vector format, .wkt (a geometry a line), .wkb, .gz of them, or -; or a terrain: any "
          "GDAL raster, .stl .obj .ply .off")
      .required();
  verb.add_option(
          "OUT", options->output,
          "Result: .gpkg .fgb .wkt .wkb (curves), .dxf (arcs), .svg (picture), .csv (pieces or points), .geojson "
          ".shp ... (chords), or -")
      .required();
  verb.add_option("--radius", options->radius, "Radius of the disk or ball, in the unit of the coordinates")
      .required()
      .type_name("R");
  verb.add_option("--from", options->from, "Where the centre starts; over a terrain without Z: resting on it")
      .required()
      .type_name("X,Y[,Z]");
  verb.add_option("--to", options->to, "Where the centre arrives, likewise").required().type_name("X,Y[,Z]");
  add_plane_options(verb, *options);
  add_flight_options(verb, *options);
  add_network_options(verb, options->input, options->format);
  session.add_common_options(verb);
  session.on_run(verb, [options, &session] {
    return is_terrain(options->input.path) ? run_terrain_route(*options, session) : run_plane_route(*options, session);
  });
}

}  // namespace krepl::app
