// krepl simulate: what a tool path leaves of a block of material, compared with the part.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <memory>

#include "input/gcode_reader.hpp"
#include "krepl/simulation.hpp"
#include "output/simulation_file.hpp"
#include "output_target.hpp"
#include "stopwatch.hpp"
#include "terrain_options.hpp"
#include "verbs.hpp"

namespace krepl::app {

namespace {

struct SimulateOptions {
  TerrainOptions terrain;
  std::vector<std::string> before;
  std::string path, tool, stock, cell, unit, control_point, output, format, rest;
};

/// MARGIN or MARGIN,TOP
Result<StockOptions> parse_stock(const std::string& text) {
  StockOptions stock;
  if (text.empty()) return stock;
  const auto number = [](std::string_view word, double& value) {
    const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
    return status == std::errc{} && end == word.data() + word.size();
  };
  const std::size_t comma = text.find(',');
  const std::string_view all = text;
  if (!number(all.substr(0, comma), stock.margin) ||
      (comma != std::string::npos && !number(all.substr(comma + 1), stock.top)))
    return Error{ErrorCode::usage, "--stock '" + text + "' is not MARGIN or MARGIN,TOP", "", "as 5 or 5,30"};
  return stock;
}

/// In millimetres.
Result<double> parse_unit(const std::string& text) {
  if (text.empty() || text == "mm") return 1.0;
  if (text == "inch" || text == "in") return 25.4;
  if (text == "cm") return 10.0;
  if (text == "m") return 1000.0;
  return Error{ErrorCode::usage, "--unit '" + text + "' is unknown", "", "give mm, cm, m or inch"};
}

struct Asked {
  Cutter cutter;
  StockOptions stock;
  double millimetres = 1, largest_rest = 0;
  bool centre = false;  // the control point
};

Result<Asked> asked(const SimulateOptions& options) {
  const Result<Cutter> cutter = Cutter::parse(options.tool);
  if (!cutter) return cutter.error();
  Result<StockOptions> stock = parse_stock(options.stock);
  if (!stock) return stock.error();
  const Result<double> unit = parse_unit(options.unit);
  if (!unit) return unit.error();
  Asked asked{*cutter, *stock, *unit};
  if (!options.control_point.empty() && options.control_point != "tip" && options.control_point != "centre")
    return Error{ErrorCode::usage, "--control-point '" + options.control_point + "' is unknown", "",
                 "give tip or centre"};
  asked.centre = options.control_point == "centre";
  for (const auto& [name, text, value] : {std::tuple{"--cell", &options.cell, &asked.stock.cell},
                                          std::tuple{"--max-rest", &options.rest, &asked.largest_rest}}) {
    if (text->empty()) continue;
    const Result<double> parsed = parse_positive(name, *text);
    if (!parsed) return parsed.error();
    *value = *parsed;
  }
  if (asked.stock.cell == 0) asked.stock.cell = cutter->radius() / 20;
  return asked;
}

/// From the point that the program steers to that of ToolPath: a ball's centre, else the tip.
void lift(ToolPath& path, const Cutter& cutter, bool centre) {
  const double lift = centre ? cutter.control_height() - cutter.radius() : cutter.control_height();
  path.start.z += lift;
  for (Move& move : path.moves) move.end.z += lift, move.centre.z += lift;
}

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

/// A program with its tool.
struct Program {
  std::string name;
  Cutter cutter;
  input::GCodeFile file;
};

/// Those of --before in their order, then PATH. Errors name the file.
Result<std::vector<Program>> read_programs(const SimulateOptions& options, const Asked& asked, Session& session) {
  std::vector<Program> programs;
  const auto read = [&](const std::string& path, const Cutter& cutter) -> Status {
    Result<input::GCodeFile> file = input::read_gcode(path, asked.millimetres, session.context("reading"));
    if (!file) {
      Error error = file.error();
      error.what = input_name(path) + ": " + error.what;
      return error;
    }
    for (const std::string& note : file->notes) session.note(input_name(path), note);
    lift(file->path, cutter, asked.centre);
    programs.push_back({input_name(path), cutter, std::move(*file)});
    return std::monostate{};
  };
  for (const std::string& text : options.before) {
    const std::size_t comma = text.rfind(',');
    if (comma == std::string::npos)
      return Error{ErrorCode::usage, "--before '" + text + "' is not PATH,TOOL", "", "as rough.ngc,flat:10"};
    const Result<Cutter> cutter = Cutter::parse(std::string_view(text).substr(comma + 1));
    if (!cutter) return cutter.error();
    if (Status done = read(text.substr(0, comma), *cutter); !done) return done.error();
  }
  if (Status done = read(options.path, asked.cutter); !done) return done.error();
  return programs;
}

int run_simulate(const SimulateOptions& options, Session& session) {
  const Stopwatch total;
  const Result<Asked> asked = app::asked(options);
  if (!asked) return session.fail("", asked.error());
  const Result<input::TerrainRequest> request = terrain_request(options.terrain);
  if (!request) return session.fail("", request.error());
  if (options.path == "-" && request->path == "-")
    return session.fail(
        "", {ErrorCode::usage, "PATH and --against are both standard input", "", "name a file for one of them"});
  if (!options.output.empty()) {
    const Result<std::string> format = output::simulation_format(options.output, options.format);
    if (!format) return session.fail(options.output, format.error());
    if (Status target = check_target(options.output, {request->path, options.path}); !target)
      return session.fail(options.output, target.error());
  }
  Result<std::vector<Program>> programs = read_programs(options, *asked, session);
  if (!programs) return session.fail("", programs.error());
  const Result<input::TerrainFile> part = input::read_terrain(*request, session.context("reading"));
  if (!part) return session.fail(options.terrain.name(), part.error());
  tell_terrain(*part, options.terrain.name(), total.seconds(), session);

  std::optional<Simulation> block;
  int status = 0;
  for (const Program& program : *programs) {
    const Stopwatch cutting;
    Result<Simulation> simulation = Simulation::run(program.file.path, *part->terrain, program.cutter, asked->stock,
                                                    session.context("cutting"), block ? &*block : nullptr);
    session.finish_progress();
    if (!simulation) return session.fail(program.name, simulation.error());
    session.detail(fmt::format("cutting    {:.3f} s", cutting.seconds()));
    if (programs->size() > 1) session.summary(fmt::format("{} with {}", program.name, program.cutter.text()));
    tell(*simulation, program.file, session);
    const bool last = &program == &programs->back();
    const std::optional<Error> fault = fault_of(*simulation, program.file, last ? asked->largest_rest : 0);
    if (fault) status = session.fail(program.name, *fault);
    block = std::move(*simulation);
  }
  if (!options.output.empty()) {
    const output::SimulationFileOptions file{options.format, part->crs, asked->largest_rest};
    if (Status written = output::write_simulation(options.output, *block, file); !written)
      return session.fail(options.output, written.error());
  }
  return status;
}

}  // namespace

void add_simulate_verb(CLI::App& program, Session& session) {
  auto options = std::make_shared<SimulateOptions>();
  CLI::App* verb = program.add_subcommand(
      "simulate", "What a tool path leaves of a block of material: gouges, rest, rapids that cut");
  verb->add_option("PATH", options->path, "Tool path: G-code (.ngc, .nc, .gcode), or -")->required();
  add_terrain_options(*verb, options->terrain, "--against");
  verb->add_option("--tool", options->tool,
                   "Cutter: ball:D, flat:D, bull:D:CORNER_RADIUS, cone:D:ANGLE or taper:D:ANGLE:TIP_RADIUS")
      ->required()
      ->type_name("TOOL");
  verb->add_option("--before", options->before,
                   "Another path with its tool, to go before PATH in the same block (may be repeated)")
      ->type_name("PATH,TOOL");
  verb->add_option("--stock", options->stock,
                   "Block: how far it reaches beyond the part, and the height of its top (default: 0, the part's own)")
      ->type_name("MARGIN[,TOP]");
  verb->add_option("--cell", options->cell, "Distance of dexels (default: a fortieth of the tool's diameter)")
      ->type_name("D");
  verb->add_option("--unit", options->unit, "Unit of the part: mm (default), cm, m, inch")->type_name("NAME");
  verb->add_option("--control-point", options->control_point,
                   "What the path's coordinates are those of: tip (default) or centre (R above it)")
      ->type_name("NAME");
  verb->add_option("--max-rest", options->rest, "Fail if more material than this is left anywhere above the part")
      ->type_name("H");
  verb->add_option("-o,--output", options->output, "Result: .tif (heights, rest, gouges) or .png (relief)")
      ->type_name("OUT");
  verb->add_option("--format", options->format, "Format of the result, in place of its extension: tif, png")
      ->type_name("NAME");
  session.add_common_options(*verb);
  session.on_run(*verb, [options, &session] { return run_simulate(*options, session); });
}

}  // namespace krepl::app
