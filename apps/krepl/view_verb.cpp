// krepl view: one self-contained page that shows a result in a browser.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "input/geometry_source.hpp"
#include "input/network_reader.hpp"
#include "input/result_file.hpp"
#include "ogr/spatial_reference.hpp"
#include "output/output_stream.hpp"
#include "verbs.hpp"
#include "view/render_page.hpp"

namespace krepl::app {

namespace {

struct ViewOptions {
  std::string result, output, title;
  input::NetworkRequest input;  // path empty: none
};

bool is_csv(const std::string& path) { return input::format_extension(path) == "csv"; }

/// The code that a coordinate system's name ends with: "WGS 84 / UTM zone 32N (EPSG:32632)" -> "EPSG:32632".
std::string code_in(const std::string& crs_name) {
  const std::size_t begin = crs_name.rfind('(');
  if (begin == std::string::npos || crs_name.back() != ')') return crs_name;
  return crs_name.substr(begin + 1, crs_name.size() - begin - 2);
}

/// The short name of a coordinate system's unit of length; empty if it cannot be told.
std::string unit_of(const std::string& crs_name) {
  if (crs_name.empty()) return "";
  auto crs = ogr::parse_crs(code_in(crs_name));
  if (!crs) return "";
  if (crs->IsGeographic()) return "°";
  const char* name = nullptr;
  const double metres = crs->GetLinearUnits(&name);
  if (metres == 1) return "m";
  return name == nullptr ? "" : name;
}

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
  page.title = options.title.empty() ? std::filesystem::path(options.result).filename().string() : options.title;
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
  const std::string html = view::render_page(*page);
  const std::string out_name = output_name(options.output);
  auto stream = output::OutputStream::open(options.output);
  if (!stream) return session.fail(out_name, stream.error());
  stream->write(html);
  if (Status written = stream->finish(); !written) return session.fail(out_name, written.error());
  std::size_t pieces = 0;
  for (const view::Layer& layer : page->layers) pieces += layer.role == "input" ? 0 : layer.kind.size();
  session.summary(fmt::format("{}: {} layers, {} pieces, {:.1f} MB; open it in a browser", out_name,
                              page->layers.size(), pieces, static_cast<double>(html.size()) / 1e6),
                  options.output == "-");
  return 0;
}

}  // namespace

void add_view_verb(CLI::App& program, Session& session) {
  auto options = std::make_shared<ViewOptions>();
  CLI::App* verb = program.add_subcommand("view", "One self-contained web page that shows a zone or a profile");
  verb->add_option("RESULT", options->result, "A zone in any vector format, or a profile (.csv)")->required();
  verb->add_option("-o,--output", options->output, "The page to write, or -")->required()->type_name("PAGE.html");
  verb->add_option("--input", options->input.path, "Show the input too: the lines, or the terrain of a profile")
      ->type_name("IN");
  verb->add_option("--layer", options->input.layer, "Layer of the input to read")->type_name("NAME");
  verb->add_option("--where", options->input.where, "Features of the input to read, as SQL")->type_name("CONDITION");
  verb->add_option("--to-crs", options->input.to_crs,
                   "Plane coordinate system to project the input to (default: the result's)")
      ->type_name("EPSG:n|auto");
  verb->add_option("--title", options->title, "Title of the page (default: name of the file)")->type_name("TEXT");
  session.add_common_options(*verb);
  session.on_run(*verb, [options, &session] { return run_view(*options, session); });
}

}  // namespace krepl::app
