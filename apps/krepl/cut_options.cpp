#include "cut_options.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "output_target.hpp"
#include "stopwatch.hpp"

namespace krepl::app {

void add_cut_options(Verb& verb, CutOptions& options, const char* result) {
  add_terrain_options(verb, options.terrain);
  verb.add_option("OUT", options.output, result).required();
  verb.add_option("--radius", options.radius, "Radius of the ball, in the unit of the coordinates")
      .required()
      .type_name("R");
  verb.add_option("--format", options.format, "Format of the result, in place of what its extension says")
      .type_name("NAME");
  verb.add_option("--max-error", options.max_error,
                  "Largest deviation of chords where a format has no true curve (default: radius / 1000)")
      .type_name("LENGTH");
}

Result<CutPlan> cut_plan(const CutOptions& options) {
  CutPlan plan;
  const Result<double> radius = parse_radius(options.radius);
  if (!radius) return radius.error();
  plan.radius = *radius;
  plan.file.max_error = plan.radius / 1000;
  if (!options.max_error.empty()) {
    const Result<double> max_error = parse_positive("--max-error", options.max_error);
    if (!max_error) return max_error.error();
    plan.file.max_error = *max_error;
  }
  const Result<output::CutFormat> format = output::find_cut_format(options.output, options.format);
  if (!format) return format.error();
  plan.format = *format;
  const Result<input::TerrainRequest> request = terrain_request(options.terrain);
  if (!request) return request.error();
  plan.request = *request;
  return plan;
}

std::unique_ptr<CutInput> read_and_compute(const CutOptions& options, CutPlan& plan, Session& session, int& status) {
  const auto fail = [&](const std::string& file, const Error& error) {
    status = session.fail(file, error);
    return nullptr;
  };
  if (Status target = check_target(options.output, {plan.request.path}); !target)
    return fail(options.output, target.error());
  const Stopwatch reading;
  const Result<input::TerrainFile> file = input::read_terrain(plan.request, session.context("reading"));
  if (!file) return fail(options.terrain.name(), file.error());
  tell_terrain(*file, options.terrain.name(), reading.seconds(), session);
  plan.file.crs = file->crs;

  const Stopwatch computing;
  Result<Surface> surface = compute_surface(file->terrain, {plan.radius}, session.context("computing"));
  if (!surface) return fail(options.terrain.name(), surface.error());
  session.detail(
      fmt::format("surface    {:.3f} s: {} faces", computing.seconds(), surface->subdivision().face_count() - 1));
  const Stopwatch indexing;
  Result<SurfaceCutter> cutter =
      SurfaceCutter::build(std::make_shared<const Surface>(std::move(*surface)), session.context("indexing"));
  if (!cutter) return fail(options.terrain.name(), cutter.error());
  session.detail(fmt::format("index      {:.3f} s", indexing.seconds()));
  return std::make_unique<CutInput>(CutInput{file->terrain, std::make_unique<SurfaceCutter>(std::move(*cutter))});
}

Result<std::vector<double>> parse_numbers(const std::string& option, const std::string& text) {
  std::vector<double> numbers;
  const char *at = text.data(), *const end = text.data() + text.size();
  for (;;) {
    double value = 0;
    const auto [next, failure] = std::from_chars(at, end, value);
    if (failure != std::errc{} || !std::isfinite(value) || (next != end && *next != ','))
      return Error{ErrorCode::usage, option + " '" + text + "' is not a list of finite numbers separated by commas", "",
                   ""};
    numbers.push_back(value);
    if (next == end) return numbers;
    at = next + 1;
  }
}

}  // namespace krepl::app
