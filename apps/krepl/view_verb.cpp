// krepl view: one self-contained page that shows a result in a browser.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "input/geometry_source.hpp"
#include "input/network_reader.hpp"
#include "input/result_file.hpp"
#include "ogr/spatial_reference.hpp"
#include "verbs.hpp"
#include "view/render_page.hpp"
#include "view_page.hpp"

namespace krepl::app {

namespace {

bool is_csv(const std::string& path) { return input::format_extension(path) == "csv"; }

/// A plane input stays where it is; degrees are projected to where the result lies, unless the user says where to.
Result<view::Layer> read_input(const ViewOptions& options, const std::string& crs, Session& session) {
  input::NetworkRequest request = options.input;
  if (is_csv(request.path)) {
    auto terrain = view::read_terrain_rows(request.path);
    if (!terrain) return terrain.error();
    return view::terrain_layer(*terrain);
  }
  if (request.to_crs.empty() && ogr::parse_crs(code_in(crs))) request.to_crs = code_in(crs);
  auto data = input::read_network(request, session.context("reading"));
  // A file without coordinate system is taken to lie where the result does.
  if (!data && options.input.to_crs.empty() && !request.to_crs.empty()) {
    request.to_crs.clear();
    auto as_it_is = input::read_network(request, session.context("reading"));
    if (as_it_is) data = std::move(as_it_is);
  }
  session.finish_progress();
  if (!data) return data.error();
  for (const std::string& note : data->notes) session.note(request.path, note);
  return view::input_layer(*data->network);
}

Result<view::PageData> read_result(const ViewOptions& options) {
  view::PageData page;
  page.title = page_title(options);
  if (is_csv(options.result)) {
    auto rows = view::read_profile_rows(options.result);
    if (!rows) return rows.error();
    auto layer = view::profile_layer(*rows);
    if (!layer) return layer.error();
    page.layers.push_back(std::move(*layer));
    return page;
  }
  auto zones = input::read_zones(options.result);
  if (!zones) return zones.error();
  auto layers = view::zone_layers(*zones);
  if (!layers) return layers.error();
  page.layers = std::move(*layers);
  page.crs = zones->front().crs;
  page.unit = unit_of(page.crs);
  return page;
}

int run_view(const ViewOptions& options, Session& session) {
  auto page = read_result(options);
  if (!page) return session.fail(options.result, page.error());
  if (!options.input.path.empty()) {
    auto layer = read_input(options, page->crs, session);
    if (!layer) return session.fail(options.input.path, layer.error());
    page->layers.push_back(std::move(*layer));
  }
  std::size_t pieces = 0;
  for (const view::Layer& layer : page->layers) pieces += layer.role == "input" ? 0 : layer.kind.size();
  return write_page(options, view::render_page(*page), fmt::format("{} layers, {} pieces", page->layers.size(), pieces),
                    session);
}

int run_any_view(const ViewOptions& options, Session& session) {
  if (is_tool_path(options.result)) return run_path_view(options, session);
  if (options.has_program_options())
    return session.fail("", {ErrorCode::usage,
                             "--tool, --before, --stock, --cell, --unit and --control-point belong to tool paths", "",
                             "give a program, .ngc or .gcode"});
  if (is_surface(options.result)) return run_surface_view(options, session);
  if (options.has_surface_options()) {
    return session.fail("", {ErrorCode::usage, "--max-error, --crs, --z-scale, --split, --band and --up belong to surfaces",
                             "", "give a subdivision that krepl terrain wrote, .json or .gpkg"});
  }
  return run_view(options, session);
}

}  // namespace

void add_view_verb(Verb& program, Session& session) {
  auto options = std::make_shared<ViewOptions>();
  Verb verb = program.add_verb("view", "One self-contained web page that shows a result");
  verb.add_option("RESULT", options->result,
                  "A zone in any vector format, a profile (.csv), a surface (.json, .gpkg), or a tool path (.ngc, .nc, "
                  ".gcode, .tap)")
      .required();
  verb.add_option("-o,--output", options->output, "The page to write, or -").required().type_name("PAGE.html");
  verb.add_option("--input", options->input.path,
                  "Show the input too: the lines, the terrain of a profile or surface, or the part of a tool path")
      .type_name("IN");
  verb.add_option("--layer", options->input.layer, "Layer of the input to read").type_name("NAME");
  verb.add_option("--where", options->input.where, "Features of the input to read, as SQL").type_name("CONDITION");
  verb.add_option("--to-crs", options->input.to_crs,
                  "Plane coordinate system to project the input to (default: the result's)")
      .type_name("EPSG:n|auto");
  verb.add_option("--crs", options->terrain.request.crs,
                  "Surface, tool path: coordinate system of the input, in place of what it says")
      .type_name("EPSG:n");
  add_reading_options(verb, options->terrain, "Surface, tool path, as the terrain was read");
  verb.add_option("--max-error", options->max_error,
                  "Surface: largest distance of the triangles that are drawn from it (default: radius / 200)")
      .type_name("LENGTH");
  verb.add_option("--tool", options->program.tool,
                  "Tool path: ball:D, flat:D, bull:D:CORNER_RADIUS, cone:D:ANGLE or taper:D:ANGLE:TIP_RADIUS")
      .type_name("TOOL");
  add_program_options(verb, options->program, "so that there are some 90,000");
  verb.add_option("--title", options->title, "Title of the page (default: name of the file)").type_name("TEXT");
  session.add_common_options(verb);
  session.on_run(verb, [options, &session] { return run_any_view(*options, session); });
}

}  // namespace krepl::app
