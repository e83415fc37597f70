#include <fmt/format.h>

#include <charconv>
#include <numeric>

#include "input/feature_reader.hpp"
#include "input/flow_field.hpp"
#include "input/network_reader.hpp"
#include "krepl/river.hpp"
#include "krepl/zone.hpp"
#include "output/river_file.hpp"
#include "network_options.hpp"
#include "output_target.hpp"
#include "stopwatch.hpp"
#include "verbs.hpp"

namespace krepl::app {

namespace {

using output::RiverPart;

struct RiversOptions {
  input::NetworkRequest input;
  std::string output, format, flow_field, snap, grid, radius, zones, max_error;
  std::vector<std::string> outlets;
  bool reaches = false;
};

/// What the options mean once they are checked; made before anything is read.
struct RiversPlan {
  RiverOptions river;
  output::ZoneFormat format;
  output::RiverFileOptions file;
  double radius = 0;  // 0: lines, not zones
  RiverPart part = RiverPart::sub_river;
};

Result<Point> parse_place(const std::string& text) {
  Point p;
  const char* const last = text.data() + text.size();
  const auto x = std::from_chars(text.data(), last, p.x);
  if (x.ec == std::errc{} && x.ptr != last && *x.ptr == ',') {
    const auto y = std::from_chars(x.ptr + 1, last, p.y);
    if (y.ec == std::errc{} && y.ptr == last) return p;
  }
  return Error{ErrorCode::usage, "--outlet '" + text + "' is not a place", "",
               "give X,Y in the coordinates of the file, or guess"};
}

Status take_outlets(const RiversOptions& options, RiverOptions& river) {
  if (options.outlets.empty()) return std::monostate{};
  if (!options.flow_field.empty()) {
    return Error{ErrorCode::usage, "--outlet and --flow-field both say which way water runs", "",
                 "leave out one of them"};
  }
  river.flow = RiverOptions::Flow::outlet;
  for (const std::string& text : options.outlets) {
    if (text == "guess") continue;
    Result<Point> place = parse_place(text);
    if (!place) return place.error();
    river.outlets.push_back(*place);
  }
  return std::monostate{};
}

Status take_zones(const RiversOptions& options, RiversPlan& plan) {
  if (options.radius.empty()) {
    const char* const alone = !options.zones.empty() ? "--zones" : !options.max_error.empty() ? "--max-error" : nullptr;
    if (alone == nullptr) return std::monostate{};
    return Error{ErrorCode::usage, std::string(alone) + " is about zones", "", "give --radius too"};
  }
  Result<double> radius = parse_radius(options.radius);
  if (!radius) return radius.error();
  plan.radius = *radius;
  if (options.reaches)
    return Error{ErrorCode::usage, "--reaches is about lines", "", "leave out --reaches or --radius"};
  if (options.zones == "stem")
    plan.part = RiverPart::stem;
  else if (options.zones == "whole")
    plan.part = RiverPart::whole;
  else if (!options.zones.empty() && options.zones != "sub-river") {
    return Error{ErrorCode::usage, "--zones '" + options.zones + "' is unknown", "", "give sub-river, stem or whole"};
  }
  if (options.max_error.empty()) return std::monostate{};
  Result<double> max_error = parse_positive("--max-error", options.max_error);
  if (!max_error) return max_error.error();
  plan.file.max_error = *max_error;
  return std::monostate{};
}

Result<RiversPlan> make_plan(const RiversOptions& options) {
  RiversPlan plan;
  if (Status outlets = take_outlets(options, plan.river); !outlets) return outlets.error();
  if (Status zones = take_zones(options, plan); !zones) return zones.error();
  if (!options.snap.empty()) {
    Result<double> snap = parse_positive("--snap", options.snap);
    if (!snap) return snap.error();
    plan.river.snap = *snap;
  }
  if (!options.grid.empty()) {
    Result<double> grid = parse_positive("--grid", options.grid);
    if (!grid) return grid.error();
    plan.river.grid = *grid;
  }
  Result<output::ZoneFormat> format = output::find_zone_format(options.output, options.format);
  if (!format)
    return Error{format.error().code, options.output + ": " + format.error().what, "", format.error().remedy};
  plan.format = *format;
  plan.file.reaches = options.reaches;
  return plan;
}

/// What was changed and what is odd, one note a matter; nothing about what is as it should be.
std::vector<std::string> findings(const RiverReport& r) {
  std::vector<std::string> notes;
  const auto note = [&](bool due, std::string text) {
    if (due) notes.push_back("note: " + std::move(text));
  };
  note(r.ignored_points > 0, fmt::format("{} points and lines without length are left out", r.ignored_points));
  note(r.repeated_vertices > 0, fmt::format("{} repeated vertices are dropped", r.repeated_vertices));
  note(r.ends_to_vertices + r.ends_to_lines > 0,
       fmt::format("{} free ends are moved to a vertex and {} to a line, by {:.6g} at most", r.ends_to_vertices,
                   r.ends_to_lines, r.largest_move));
  note(r.crossings > 0, fmt::format("{} vertices are added where lines cross", r.crossings));
  note(r.touches > 0, fmt::format("lines are cut {} times where vertices lie on them", r.touches));
  note(r.duplicates > 0,
       fmt::format("{} segments that others cover are dropped (length {:.6g}); {} of them ran the other way",
                   r.duplicates, r.duplicate_length, r.opposed_duplicates));
  note(r.guessed_outlets > 0, fmt::format("{} outlets are guessed", r.guessed_outlets));
  note(r.outlet_distance > 0, fmt::format("the outlets given are up to {:.6g} from their vertex", r.outlet_distance));
  note(r.cycle_reaches > 0, fmt::format("{} reaches close a cycle and are sub-rivers of their own", r.cycle_reaches));
  return notes;
}

void tell_details(const RiverNetwork& rivers, double seconds, Session& session) {
  const RiverReport& r = rivers.report();
  std::size_t sources = 0, drains = 0, fusions = 0, bifurcations = 0;
  for (const RiverNetwork::Node& node : rivers.nodes()) {
    sources += node.is_source() ? 1 : 0;
    drains += node.is_drain() ? 1 : 0;
    fusions += node.is_fusion() ? 1 : 0;
    bifurcations += node.is_bifurcation() ? 1 : 0;
  }
  session.detail(fmt::format(
      "rivers     {:.3f} s: {} lines of length {:.6g}; vertices on a grid of {:.3g}, moved by {:.3g} at most", seconds,
      r.lines, r.input_length, r.grid, r.largest_move));
  session.detail(fmt::format("nodes      {}: {} sources, {} drains, {} fusion vertices, {} bifurcations",
                             rivers.nodes().size(), sources, drains, fusions, bifurcations));
  session.detail(fmt::format("flow       {} reaches turned against the way they were digitised", r.turned_reaches));
}

std::string summary_line(const RiverNetwork& rivers, const std::vector<Zone>& zones, double seconds) {
  double length = 0;
  std::uint32_t order = 0;
  for (const RiverNetwork::Reach& reach : rivers.reaches()) {
    length += reach.length;
    order = std::max(order, reach.order);
  }
  std::string text = fmt::format(
      "{} reaches, {} sub-rivers, {} main stems, {} connected parts; length {:.10g}, order {}", rivers.reaches().size(),
      rivers.sub_rivers().size(), rivers.report().rivers, rivers.report().components, length, order);
  if (!zones.empty()) {
    double area = 0;
    for (const Zone& zone : zones) area += zone.area();
    text += fmt::format("; {} zones of radius {}, areas {:.10g} in all", zones.size(), zones.front().radius(), area);
  }
  return text + fmt::format("; {:.3f} s", seconds);
}

/// The sub-rivers of each zone, in the order that write_river_zones wants.
std::vector<std::vector<RiverNetwork::Index>> parts_of(const RiverNetwork& rivers, RiverPart part) {
  const auto count = RiverNetwork::Index(rivers.sub_rivers().size());
  std::vector<std::vector<RiverNetwork::Index>> parts(part == RiverPart::whole ? 1 : count);
  for (RiverNetwork::Index s = 0; s < count; ++s) {
    parts[part == RiverPart::whole ? 0 : part == RiverPart::stem ? rivers.sub_rivers()[s].stem : s].push_back(s);
  }
  std::erase_if(parts, [](const auto& members) { return members.empty(); });
  return parts;
}

Result<std::vector<Zone>> compute_zones(const RiverNetwork& rivers, const RiversPlan& plan, Session& session) {
  std::vector<Zone> zones;
  if (plan.radius == 0) return zones;
  Context context = session.context("computing");
  const auto parts = parts_of(rivers, plan.part);
  for (const auto& members : parts) {
    if (context.progress) context.progress(double(zones.size()) / double(parts.size()));
    Context quiet = context;
    if (parts.size() > 1) quiet.progress = nullptr;
    Result<Network> network = rivers.network(members, quiet);
    if (!network) return network.error();
    Result<Zone> zone = compute_zone(std::make_shared<const Network>(std::move(*network)), {plan.radius}, quiet);
    if (!zone) {
      Error error = zone.error();
      if (parts.size() > 1 && error.where.empty()) error.where = "sub-river " + std::to_string(members.front() + 1);
      return error;
    }
    zones.push_back(std::move(*zone));
  }
  return zones;
}

Status write(const RiversOptions& options, const RiversPlan& plan, const RiverNetwork& rivers,
             const std::vector<Zone>& zones, Session& session) {
  const std::string name = output_name(options.output);
  if (plan.radius == 0) {
    auto notes = output::write_rivers(options.output, rivers, plan.format, plan.file, session.context("writing"));
    if (!notes) return notes.error();
    for (const std::string& note : *notes) session.note(name, note);
    return std::monostate{};
  }
  auto report = output::write_river_zones(options.output, rivers, plan.part, zones, plan.format, plan.file,
                                          session.context("writing"));
  if (!report) return report.error();
  for (const std::string& note : report->notes) session.note(name, note);
  if (report->deviation) {
    session.note(name, fmt::format("note: {} has no arcs; the polygons deviate from the true zone by {:.6g} at most",
                                   plan.format.name, *report->deviation));
  }
  return std::monostate{};
}

int run_rivers(const RiversOptions& options, Session& session) {
  Stopwatch total;
  Result<RiversPlan> plan = make_plan(options);
  if (!plan) return session.fail("", plan.error());
  if (Status target = check_target(options.output, {options.input.path}); !target)
    return session.fail(options.output, target.error());

  const std::string in_name = input_name(options.input.path);
  input::NetworkRequest request = options.input;
  request.places = plan->river.outlets;
  Result<input::NetworkData> data = input::read_network(request, session.context("reading"));
  if (!data) return session.fail(in_name, data.error());
  for (const std::string& note : data->notes) session.note(in_name, note);
  if (!options.flow_field.empty()) {
    Result<input::FlowField> flow =
        input::read_flow_field(options.input, options.flow_field, session.context("reading"));
    if (!flow) return session.fail(in_name, flow.error());
    if (flow->unknown > 0) {
      session.note(in_name, fmt::format("note: {} features do not say which way water runs and are taken as digitised",
                                        flow->unknown));
    }
    plan->river.against = std::move(flow->against);
  }

  plan->river.outlets = data->places;

  Stopwatch building;
  Result<RiverNetwork> rivers = RiverNetwork::build(*data->network, plan->river, session.context("joining"));
  if (!rivers) return session.fail(in_name, rivers.error());
  for (const std::string& note : findings(rivers->report())) session.note(in_name, note);
  tell_details(*rivers, building.seconds(), session);

  Result<std::vector<Zone>> zones = compute_zones(*rivers, *plan, session);
  if (!zones) return session.fail(in_name, zones.error());
  plan->file.crs = data->crs;
  auto attributes = input::read_attributes(options.input, session.context("reading"));
  if (!attributes) return session.fail(in_name, attributes.error());
  plan->file.attributes = std::move(*attributes);
  if (Status written = write(options, *plan, *rivers, *zones, session); !written) {
    return session.fail(output_name(options.output), written.error());
  }
  session.summary(summary_line(*rivers, *zones, total.seconds()), options.output == "-");
  return 0;
}

}  // namespace

void add_rivers_verb(Verb& program, Session& session) {
  auto options = std::make_shared<RiversOptions>();
  Verb verb = program.add_verb(
      "rivers", "Rivers taken apart into sub-rivers from source to drain, with orders and main stems; zones of them");
  verb.add_option("IN", options->input.path, "Vector file of lines: any OGR format, .wkt, .wkb, .gz of them, or -")
      .required();
  verb.add_option("OUT", options->output,
                  "Sub-rivers (or zones): .gpkg .fgb .geojson .shp .csv ..., .wkt .wkb .svg, or -")
      .required();
  verb.add_option("--outlet", options->outlets,
                  "Water runs to the vertex nearest to here, or to a guessed end, not the way lines were digitised; "
                  "may be repeated")
      .type_name("X,Y|guess")
      .one_each();
  verb.add_option("--flow-field", options->flow_field,
                  "Field that says whether a line was digitised with the water (1, with) or against it (-1, against)")
      .type_name("NAME");
  verb.add_option("--snap", options->snap, "Free ends of lines this near to another line are moved to it")
      .type_name("LENGTH");
  verb.add_option("--grid", options->grid,
                  "Vertices and crossings are rounded to a grid of this pitch at most (default: finest)")
      .type_name("LENGTH");
  verb.add_flag("--reaches", options->reaches, "A line for each reach from node to node, not for each sub-river");
  verb.add_option("--radius", options->radius, "Write zones of this radius in place of lines").type_name("R");
  verb.add_option("--zones", options->zones,
                  "A zone for each sub-river (default), each main stem with its tributaries, or the whole")
      .type_name("sub-river|stem|whole");
  add_network_options(verb, options->input, options->format);
  verb.add_option("--max-error", options->max_error,
                  "Zones in formats without arcs: largest deviation (default: radius / 1000)")
      .type_name("LENGTH");
  session.add_common_options(verb);
  session.on_run(verb, [options, &session] { return run_rivers(*options, session); });
}

}  // namespace krepl::app
