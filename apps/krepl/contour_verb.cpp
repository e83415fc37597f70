// krepl contour: waterlines of a surface.
#include <fmt/format.h>

#include <cmath>

#include "cut_options.hpp"
#include "stopwatch.hpp"

namespace krepl::app {

namespace {

struct ContourVerbOptions {
  CutOptions cut;
  std::string levels, step, ties = "high";
};

constexpr double most_levels = 100000;

/// Heights, absolute; of --step, those between the lowest and the highest of the surface.
Result<std::vector<double>> levels_of(const ContourVerbOptions& options, const Terrain& terrain, double radius) {
  if (!options.levels.empty()) return parse_numbers("--level", options.levels);
  const Result<double> step = parse_positive("--step", options.step);
  if (!step) return step.error();
  const double first = std::ceil((terrain.lowest().z + terrain.origin().z) / *step);
  const double last = std::floor((terrain.highest().z + terrain.origin().z + radius) / *step);
  if (!(last - first < most_levels))
    return Error{ErrorCode::usage, fmt::format("--step {} would give {:.0f} levels", options.step, last - first + 1),
                 "", "give a larger step"};
  std::vector<double> levels;
  for (double i = first; i <= last; ++i) levels.push_back(i * *step);
  return levels;
}

Status check(const ContourVerbOptions& options) {
  if (options.levels.empty() == options.step.empty())
    return Error{ErrorCode::usage, "give either --level or --step", "", ""};
  if (!options.levels.empty()) {
    if (const auto levels = parse_numbers("--level", options.levels); !levels) return levels.error();
  } else if (const auto step = parse_positive("--step", options.step); !step) {
    return step.error();
  }
  return std::monostate{};
}

int run_contour(const ContourVerbOptions& options, Session& session) {
  const Stopwatch total;
  Result<CutPlan> plan = cut_plan(options.cut);
  if (!plan) return session.fail("", plan.error());
  if (Status checked = check(options); !checked) return session.fail("", checked.error());
  int status = 0;
  const std::unique_ptr<CutInput> input = read_and_compute(options.cut, *plan, session, status);
  if (!input) return status;
  const Result<std::vector<double>> levels = levels_of(options, *input->terrain, plan->radius);
  if (!levels) return session.fail("", levels.error());

  const Stopwatch cutting;
  std::vector<double> local;
  for (const double z : *levels) local.push_back(z - input->terrain->origin().z);
  const Result<std::vector<Contour>> contours =
      input->cutter->contours(local, {options.ties == "high"}, session.context("cutting"));
  if (!contours) return session.fail(options.cut.terrain.name(), contours.error());
  session.detail(fmt::format("cutting    {:.3f} s", cutting.seconds()));
  const std::string name = output_name(options.cut.output);
  const Result<output::CutFileReport> report = output::write_contours(
      options.cut.output, *contours, *input->terrain, plan->format, plan->file, session.context("writing"));
  if (!report) return session.fail(name, report.error());
  for (const std::string& note : report->notes) session.note(name, note);

  std::size_t rings = 0, holes = 0, pieces = 0;
  for (const Contour& contour : *contours) {
    rings += contour.ring_count();
    pieces += contour.pieces.size();
    for (const bool hole : contour.ring_is_hole) holes += hole;
  }
  session.summary(fmt::format("{} triangles; {} levels: {} rings, {} of them holes, of {} pieces{}; {:.3f} s",
                              input->terrain->triangle_count(), levels->size(), rings, holes, pieces,
                              report->has_chords ? fmt::format(", curves within {:.3g}", plan->file.max_error) : "",
                              total.seconds()),
                  options.cut.output == "-");
  return 0;
}

}  // namespace

void add_contour_verb(Verb& program, Session& session) {
  auto options = std::make_shared<ContourVerbOptions>();
  Verb verb = program.add_verb("contour", "Waterlines of the surface of a ball's centre, of true curves");
  add_cut_options(verb, options->cut,
                  "Result: .csv (pieces), .gpkg .geojson .shp ... (rings), .wkt, .svg, .dxf, or - (CSV)");
  verb.add_option("--level", options->levels, "Heights of the ball's centre, separated by commas").type_name("Z,...");
  verb.add_option("--step", options->step, "All whole multiples of this height instead").type_name("DZ");
  verb.add_option("--ties", options->ties,
                  "What lies exactly at a level belongs to the high (default) or the low side")
      .one_of({"high", "low"})
      .type_name("SIDE");
  session.add_common_options(verb);
  session.on_run(verb, [options, &session] { return run_contour(*options, session); });
}

}  // namespace krepl::app
