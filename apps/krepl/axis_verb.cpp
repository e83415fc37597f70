#include <fmt/format.h>

#include <limits>

#include "input/network_reader.hpp"
#include "krepl/voronoi.hpp"
#include "output/axis_file.hpp"
#include "network_options.hpp"
#include "output_target.hpp"
#include "stopwatch.hpp"
#include "verbs.hpp"

namespace krepl::app {

namespace {

struct AxisOptions {
  input::NetworkRequest input;
  std::string output, max_error, max_clearance, format;
  bool all = false;
};

/// What the options mean once they are checked; made before anything is read.
struct AxisPlan {
  output::ZoneFormat format;
  double max_error = 0, max_clearance = 0;  // 0: a default by the extent
};

Result<AxisPlan> make_plan(const AxisOptions& options) {
  AxisPlan plan;
  for (auto [name, text, value] : {std::tuple{"--max-error", &options.max_error, &plan.max_error},
                                   {"--max-clearance", &options.max_clearance, &plan.max_clearance}}) {
    if (text->empty()) continue;
    Result<double> number = parse_positive(name, *text);
    if (!number) return number.error();
    *value = *number;
  }
  Result<output::ZoneFormat> format = output::find_zone_format(options.output, options.format);
  if (!format)
    return Error{format.error().code, options.output + ": " + format.error().what, "", format.error().remedy};
  plan.format = *format;
  return plan;
}

std::string site_name(const VoronoiDiagram::Site& site) {
  return fmt::format("{}{}", site.is_vertex ? 'v' : 's', site.index);
}

std::int64_t feature_of(const Network& network, const VoronoiDiagram::Site& site) {
  return (site.is_vertex ? network.vertex_source(site.index) : network.segment_source(site.index)).feature;
}

/// The edges asked for, as lines, one at a time.
class AxisLines {
 public:
  AxisLines(const VoronoiDiagram& diagram, const AxisPlan& plan, bool all)
      : diagram_(diagram), plan_(plan), all_(all) {}

  void each(const std::function<bool(const output::AxisLine&)>& take) {
    const Network& network = diagram_.network();
    for (const VoronoiDiagram::Edge& edge : diagram_.edges()) {
      if (edge.touches_site && !all_) continue;
      output::AxisLine line;
      line.points = diagram_.points(edge, plan_.max_error, plan_.max_clearance);
      if (line.points.size() < 2 || (line.points.size() == 2 && line.points[0] == line.points[1])) continue;
      line.control = diagram_.control_point(edge, plan_.max_clearance);
      line.kind = edge.parabolic ? "parabola" : "line";
      line.start_clearance = std::min(edge.start_clearance, plan_.max_clearance);
      line.end_clearance = std::min(edge.end_clearance, plan_.max_clearance);
      line.minimum = edge.minimum;
      line.left_feature = feature_of(network, edge.left), line.right_feature = feature_of(network, edge.right);
      line.left_site = site_name(edge.left), line.right_site = site_name(edge.right);
      ++written_;
      if (!take(line)) return;
    }
  }
  std::size_t written() const { return written_; }

 private:
  const VoronoiDiagram& diagram_;
  const AxisPlan& plan_;
  bool all_;
  std::size_t written_ = 0;
};

int run_axis(const AxisOptions& options, Session& session) {
  Stopwatch total;
  Result<AxisPlan> plan = make_plan(options);
  if (!plan) return session.fail("", plan.error());
  if (Status target = check_target(options.output, {options.input.path}); !target)
    return session.fail(options.output, target.error());
  const std::string in_name = input_name(options.input.path), out_name = output_name(options.output);
  Result<input::NetworkData> data = input::read_network(options.input, session.context("reading"));
  if (!data) return session.fail(in_name, data.error());
  for (const std::string& note : data->notes) session.note(in_name, note);
  const double extent = data->network->extent();
  if (plan->max_clearance == 0) plan->max_clearance = extent > 0 ? 2 * extent : 1;
  if (plan->max_error == 0) plan->max_error = extent > 0 ? extent / 10000 : 1;

  Stopwatch building;
  Result<VoronoiDiagram> diagram = VoronoiDiagram::build(data->network, session.context("diagram"));
  if (!diagram) return session.fail(in_name, diagram.error());
  const VoronoiCounters& c = diagram->counters();
  session.detail(fmt::format("diagram    {:.3f} s: {} faces, {} edges, {} vertices", building.seconds(), c.faces,
                             diagram->edge_count(), diagram->vertex_count()));
  session.detail(fmt::format(
      "faces      {} candidates; {} done again in pairs of doubles, {} in quadruple precision, {} in 320 bits; {} vertices, {} links reconciled",
      c.candidates, c.faces_in_pairs, c.faces_in_quadruple, c.faces_in_320_bits, c.vertices_in_quadruple, c.links_reconciled));

  AxisLines lines(*diagram, *plan, options.all);
  const output::AxisSource source = [&](const auto& take) { lines.each(take); };
  Status written = plan->format.kind == output::ZoneFormat::Kind::svg
                       ? output::write_axis_svg(options.output, source, *data->network, session.context("writing"))
                       : output::write_axis(options.output, source, plan->format, data->crs, session.context("writing"));
  if (!written) return session.fail(out_name, written.error());
  session.summary(fmt::format("{} segments; {} edges of the {}; {:.3f} s", data->network->segments().size(),
                              lines.written(), options.all ? "Voronoi diagram" : "medial axis", total.seconds()),
                  options.output == "-");
  return 0;
}

}  // namespace

void add_axis_verb(Verb& program, Session& session) {
  auto options = std::make_shared<AxisOptions>();
  Verb verb =
      program.add_verb("axis", "Medial axis or Voronoi diagram of lines, polygons and points, with clearances");
  verb.add_option("IN", options->input.path,
                  "Vector file: any OGR format, .wkt (a geometry a line), .wkb, .gz of them, or -")
      .required();
  verb.add_option("OUT", options->output,
                  "Result: .gpkg .fgb .geojson .shp ... (lines with attributes), .wkt (lines), .svg (a picture), or -")
      .required();
  verb.add_flag("--all", options->all, "The whole Voronoi diagram: also the perpendiculars at the ends of segments");
  verb.add_option("--max-error", options->max_error,
                  "Largest deviation of chords from parabolas (default: extent / 10000)")
      .type_name("LENGTH");
  verb.add_option("--max-clearance", options->max_clearance,
                  "Only what is no farther than this from the input (default: 2 extents)")
      .type_name("LENGTH");
  add_network_options(verb, options->input, options->format);
  session.add_common_options(verb);
  session.on_run(verb, [options, &session] { return run_axis(*options, session); });
}

}  // namespace krepl::app
