// krepl simulate: what a tool path leaves of a block of material, compared with the part.
#include <fmt/format.h>

#include <memory>

#include "krepl/simulation.hpp"
#include "output/simulation_file.hpp"
#include "output_target.hpp"
#include "stopwatch.hpp"
#include "terrain_options.hpp"
#include "tool_programs.hpp"
#include "verbs.hpp"

namespace krepl::app {

namespace {

struct SimulateOptions {
  TerrainOptions terrain;
  ProgramOptions program;
  std::string output, format, rest;
};

/// So many dexels a radius of the tool if nobody says how far apart they are.
constexpr double dexels_of_radius = 20;

std::string at(const Simulation::Extreme& extreme) {
  return fmt::format("at {:.9g} {:.9g} {:.9g}", extreme.place.x, extreme.place.y, extreme.place.z);
}

void tell(const Simulation& simulation, const input::GCodeFile& file, Session& session) {
  const Simulation::Report& report = simulation.report();
  const auto line = [&](const Simulation::Extreme& extreme) { return fmt::format("line {}", file.line[extreme.move]); };
  session.summary(fmt::format("path      {} moves: {:.6g} cutting in {:.4g} minutes, {:.6g} rapid",
                              file.path.moves.size(), report.cutting_length, report.cutting_minutes,
                              report.rapid_length));
  session.summary(fmt::format("block     {} x {} dexels, {} over the part; {:.6g} of {:.6g} removed",
                              simulation.columns(), simulation.rows(), report.dexels_over_part, report.removed_volume,
                              report.stock_volume));
  session.summary(report.gouge.value > 0
                      ? fmt::format("gouge     {:.6g} {}, {}; {} dexels", report.gouge.value, at(report.gouge),
                                    line(report.gouge), report.gouged_dexels)
                      : fmt::format("gouge     none deeper than {:.2g} on the dexels", simulation.depth_tolerance()));
  session.summary(report.rest.value > 0
                      ? fmt::format("rest      {:.6g} above the part {}", report.rest.value, at(report.rest))
                      : std::string("rest      none"));
  session.summary(report.cutting_rapids > 0
                      ? fmt::format("rapids    {} cut into material, {:.6g} deep {}, {}", report.cutting_rapids,
                                    report.rapid_cut.value, at(report.rapid_cut), line(report.rapid_cut))
                      : std::string("rapids    none cuts into material"));
}

/// What is wrong with the path, if anything.
std::optional<Error> fault_of(const Simulation& simulation, const input::GCodeFile& file, double largest_rest) {
  const Simulation::Report& report = simulation.report();
  const auto fault = [&](const char* what, const Simulation::Extreme& extreme) {
    return Error{ErrorCode::computation, fmt::format("{} {:.6g} deep", what, extreme.value),
                 fmt::format("line {}, {}", file.line[extreme.move], at(extreme)), ""};
  };
  if (report.gouge.value > 0) return fault("cuts into the part,", report.gouge);
  if (report.cutting_rapids > 0) return fault("a rapid move cuts into material,", report.rapid_cut);
  if (largest_rest > 0 && report.rest.value > largest_rest)
    return Error{ErrorCode::computation, fmt::format("leaves {:.6g} above the part", report.rest.value),
                 at(report.rest), ""};
  return std::nullopt;
}

int run_simulate(const SimulateOptions& options, Session& session) {
  const Stopwatch total;
  Result<ProgramSetup> setup = program_setup(options.program);
  if (!setup) return session.fail("", setup.error());
  if (setup->stock.cell == 0) setup->stock.cell = setup->cutter.radius() / dexels_of_radius;
  double largest_rest = 0;
  if (!options.rest.empty()) {
    const Result<double> parsed = parse_positive("--max-rest", options.rest);
    if (!parsed) return session.fail("", parsed.error());
    largest_rest = *parsed;
  }
  const Result<input::TerrainRequest> request = terrain_request(options.terrain);
  if (!request) return session.fail("", request.error());
  if (options.program.path == "-" && request->path == "-")
    return session.fail(
        "", {ErrorCode::usage, "PATH and --against are both standard input", "", "name a file for one of them"});
  if (!options.output.empty()) {
    const Result<std::string> format = output::simulation_format(options.output, options.format);
    if (!format) return session.fail(options.output, format.error());
    if (Status target = check_target(options.output, {request->path, options.program.path}); !target)
      return session.fail(options.output, target.error());
  }
  Result<std::vector<Program>> programs = read_programs(options.program, *setup, session);
  if (!programs) return session.fail("", programs.error());
  const Result<input::TerrainFile> part = input::read_terrain(*request, session.context("reading"));
  if (!part) return session.fail(options.terrain.name(), part.error());
  tell_terrain(*part, options.terrain.name(), total.seconds(), session);

  std::optional<Simulation> block;
  int status = 0;
  for (const Program& program : *programs) {
    const Stopwatch cutting;
    Result<Simulation> simulation = Simulation::run(program.file.path, *part->terrain, program.cutter, setup->stock,
                                                    session.context("cutting"), block ? &*block : nullptr);
    session.finish_progress();
    if (!simulation) return session.fail(program.name, simulation.error());
    session.detail(fmt::format("cutting    {:.3f} s", cutting.seconds()));
    if (programs->size() > 1) session.summary(fmt::format("{} with {}", program.name, program.cutter.text()));
    tell(*simulation, program.file, session);
    const bool last = &program == &programs->back();
    const std::optional<Error> fault = fault_of(*simulation, program.file, last ? largest_rest : 0);
    if (fault) status = session.fail(program.name, *fault);
    block = std::move(*simulation);
  }
  if (!options.output.empty()) {
    const output::SimulationFileOptions file{options.format, part->crs, largest_rest};
    if (Status written = output::write_simulation(options.output, *block, file); !written)
      return session.fail(options.output, written.error());
  }
  return status;
}

}  // namespace

void add_simulate_verb(Verb& program, Session& session) {
  auto options = std::make_shared<SimulateOptions>();
  Verb verb = program.add_verb(
      "simulate", "What a tool path leaves of a block of material: gouges, rest, rapids that cut");
  verb.add_option("PATH", options->program.path, "Tool path: G-code (.ngc, .nc, .gcode), or -").required();
  add_terrain_options(verb, options->terrain, "--against");
  verb.add_option("--tool", options->program.tool,
                  "Cutter: ball:D, flat:D, bull:D:CORNER_RADIUS, cone:D:ANGLE or taper:D:ANGLE:TIP_RADIUS")
      .required()
      .type_name("TOOL");
  add_program_options(verb, options->program, "a fortieth of the tool's diameter");
  verb.add_option("--max-rest", options->rest, "Fail if more material than this is left anywhere above the part")
      .type_name("H");
  verb.add_option("-o,--output", options->output, "Result: .tif (heights, rest, gouges) or .png (relief)")
      .type_name("OUT");
  verb.add_option("--format", options->format, "Format of the result, in place of its extension: tif, png")
      .type_name("NAME");
  session.add_common_options(verb);
  session.on_run(verb, [options, &session] { return run_simulate(*options, session); });
}

}  // namespace krepl::app
