// krepl section: a surface along lines.
#include <fmt/format.h>


#include "cut_options.hpp"
#include "stopwatch.hpp"

namespace krepl::app {

namespace {

struct SectionVerbOptions {
  CutOptions cut;
  std::vector<std::string> from, to;
};

Result<Point> parse_place(const std::string& option, const std::string& text) {
  const Result<std::vector<double>> numbers = parse_numbers(option, text);
  if (!numbers || numbers->size() != 2)
    return Error{ErrorCode::usage, option + " '" + text + "' is not a place", "", "give x,y"};
  return Point{(*numbers)[0], (*numbers)[1]};
}

Result<std::vector<SurfaceCutter::Line>> lines_of(const SectionVerbOptions& options) {
  if (options.from.size() != options.to.size())
    return Error{ErrorCode::usage,
                 fmt::format("--from is given {} times, --to {} times", options.from.size(), options.to.size()), "",
                 "give both ends of each line"};
  std::vector<SurfaceCutter::Line> lines;
  for (std::size_t i = 0; i < options.from.size(); ++i) {
    const Result<Point> from = parse_place("--from", options.from[i]), to = parse_place("--to", options.to[i]);
    if (!from) return from.error();
    if (!to) return to.error();
    if (*from == *to) return Error{ErrorCode::usage, "the ends of a line are equal", options.from[i], ""};
    lines.push_back({*from, *to});
  }
  return lines;
}

int run_section(const SectionVerbOptions& options, Session& session) {
  const Stopwatch total;
  Result<CutPlan> plan = cut_plan(options.cut);
  if (!plan) return session.fail("", plan.error());
  Result<std::vector<SurfaceCutter::Line>> lines = lines_of(options);
  if (!lines) return session.fail("", lines.error());
  int status = 0;
  const std::unique_ptr<CutInput> input = read_and_compute(options.cut, *plan, session, status);
  if (!input) return status;

  const Stopwatch cutting;
  const Point3 origin = input->terrain->origin();
  for (SurfaceCutter::Line& line : *lines) {
    for (Point* p : {&line.from, &line.to}) *p = {p->x - origin.x, p->y - origin.y};
  }
  const Result<std::vector<Section>> sections = input->cutter->sections(*lines, session.context("cutting"));
  if (!sections) return session.fail(options.cut.terrain.name(), sections.error());
  session.detail(fmt::format("cutting    {:.3f} s", cutting.seconds()));
  const std::string name = output_name(options.cut.output);
  const Result<output::CutFileReport> report = output::write_sections(
      options.cut.output, *sections, *input->terrain, plan->format, plan->file, session.context("writing"));
  if (!report) return session.fail(name, report.error());
  for (const std::string& note : report->notes) session.note(name, note);

  std::size_t chains = 0, pieces = 0;
  for (const Section& section : *sections) {
    chains += section.chain_count();
    pieces += section.pieces.size();
  }
  session.summary(fmt::format("{} triangles; {} lines: {} chains of {} pieces{}; {:.3f} s",
                              input->terrain->triangle_count(), lines->size(), chains, pieces,
                              report->has_chords ? fmt::format(", curves within {:.3g}", plan->file.max_error) : "",
                              total.seconds()),
                  options.cut.output == "-");
  return 0;
}

}  // namespace

void add_section_verb(Verb& program, Session& session) {
  auto options = std::make_shared<SectionVerbOptions>();
  Verb verb = program.add_verb("section", "The surface of a ball's centre along lines, of true curves");
  add_cut_options(verb, options->cut,
                  "Result: .csv (pieces), .gpkg .geojson .shp ... (lines in space), .wkt, .svg .dxf (distance and "
                  "height), or - (CSV)");
  verb.add_option("--from", options->from, "Start of a line; once for each")
      .required()
      .type_name("X,Y")
      .one_each();
  verb.add_option("--to", options->to, "End of a line; once for each")
      .required()
      .type_name("X,Y")
      .one_each();
  session.add_common_options(verb);
  session.on_run(verb, [options, &session] { return run_section(*options, session); });
}

}  // namespace krepl::app
