// krepl view of tool paths.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "input/terrain_reader.hpp"
#include "stopwatch.hpp"
#include "verbs.hpp"
#include "view/path/path_page.hpp"
#include "view_page.hpp"

namespace krepl::app {

namespace {

/// A page plays fluently without graphics hardware up to about so many dexels.
constexpr double usual_dexels = 90000;
constexpr double dexels_of_radius = 20;

double usual_cell(const Terrain& part, const ProgramSetup& setup) {
  const double width = part.highest().x - part.lowest().x + 2 * setup.stock.margin,
               height = part.highest().y - part.lowest().y + 2 * setup.stock.margin;
  const double finest = setup.cutter.radius() / dexels_of_radius;
  return std::max({finest, std::sqrt(width * height / usual_dexels), std::max(width, height) / usual_dexels});
}

/// All programs in turn on one block.
Result<view::Material> cut(const std::vector<Program>& programs, const Terrain& part, const ProgramSetup& setup, Session& session) {
  std::optional<Simulation> before;
  for (const Program& program : programs) {
    auto simulation = Simulation::run(program.file.path, part, program.cutter, setup.stock, session.context("cutting"),
                                      before ? &*before : nullptr);
    session.finish_progress();
    if (!simulation) return simulation.error();
    if (&program != &programs.back()) {
      before = std::move(*simulation);
      continue;
    }
    return view::Material{std::move(*simulation), before ? before->left() : std::vector<double>(), &part};
  }
  return Error{ErrorCode::input, "there is no program", "", ""};
}

std::optional<Error> refuse_options(const ViewOptions& options) {
  const ProgramOptions& program = options.program;
  if (program.tool.empty())
    return Error{ErrorCode::usage, "a tool path does not tell its tool", "", "give --tool ball:D or another cutter"};
  if (!options.input.layer.empty() || !options.input.where.empty())
    return Error{ErrorCode::usage, "--layer and --where belong to zones", "", "a part has no features to choose"};
  if (!options.max_error.empty())
    return Error{ErrorCode::usage, "--max-error belongs to surfaces", "", "--cell sets how finely material is shown"};
  if (options.input.path.empty() && (!program.before.empty() || !program.stock.empty() || !program.cell.empty()))
    return Error{ErrorCode::usage, "--before, --stock and --cell are about material", "", "give the part with --input"};
  return std::nullopt;
}

}  // namespace

int run_path_view(const ViewOptions& options, Session& session) {
  if (const auto error = refuse_options(options)) return session.fail("", *error);
  ProgramOptions asked = options.program;
  asked.path = options.result;
  auto setup = program_setup(asked);
  if (!setup) return session.fail("", setup.error());
  auto programs = read_programs(asked, *setup, session);
  session.finish_progress();
  if (!programs) return session.fail("", programs.error());
  const Program& program = programs->back();

  view::PathPageData page{page_title(options), "", &program.file.path, program.file.line, program.cutter};
  std::optional<input::TerrainFile> part;
  std::optional<view::Material> material;
  if (!options.input.path.empty()) {
    const Stopwatch reading;
    TerrainOptions terrain = options.terrain;
    terrain.request.path = options.input.path, terrain.request.to_crs = options.input.to_crs;
    auto request = terrain_request(terrain);
    if (!request) return session.fail("", request.error());
    auto file = input::read_terrain(*request, session.context("reading"));
    session.finish_progress();
    if (!file) return session.fail(options.input.path, file.error());
    tell_terrain(*file, options.input.path, reading.seconds(), session);
    part = std::move(*file);
    if (setup->stock.cell == 0) setup->stock.cell = usual_cell(*part->terrain, *setup);
    const Stopwatch cutting;
    auto result = cut(*programs, *part->terrain, *setup, session);
    if (!result) return session.fail(options.result, result.error());
    session.detail(fmt::format("cutting    {:.3f} s", cutting.seconds()));
    material = std::move(*result);
    page.material = &*material;
    page.unit = part->crs_name.empty() ? asked.unit.empty() ? "mm" : asked.unit : unit_of(part->crs_name);
  } else {
    page.unit = asked.unit.empty() ? "mm" : asked.unit;
  }
  const auto html = view::render_path_page(page, session.context("page"));
  session.finish_progress();
  if (!html) return session.fail(options.result, html.error());
  std::string contents = fmt::format("{} moves, {:.4g} minutes", program.file.path.moves.size(), html->minutes);
  if (material) {
    const Simulation::Report& report = material->finished.report();
    contents += fmt::format(", {} dexels, gouge {:.3g}, rest {:.3g}", report.dexels, report.gouge.value, report.rest.value);
  }
  return write_page(options, html->html, contents, session);
}

}  // namespace krepl::app
