// Programs of G-code, their tools and the block that they cut: what simulate and view have in common.
#include "tool_programs.hpp"

#include <charconv>
#include <tuple>

#include "input/geometry_source.hpp"
#include "terrain_options.hpp"
#include "verbs.hpp"

namespace krepl::app {

namespace {

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

/// From the point that the program steers to that of ToolPath: a ball's centre, else the tip.
void lift(ToolPath& path, const Cutter& cutter, bool centre) {
  const double lift = centre ? cutter.control_height() - cutter.radius() : cutter.control_height();
  path.start.z += lift;
  for (Move& move : path.moves) move.end.z += lift, move.centre.z += lift;
}

}  // namespace

void add_program_options(Verb& verb, ProgramOptions& options, const std::string& cell_default) {
  verb.add_option("--before", options.before,
                  "Another path with its tool, to go before PATH in the same block (may be repeated)")
      .type_name("PATH,TOOL");
  verb.add_option("--stock", options.stock,
                  "Block: how far it reaches beyond the part, and the height of its top (default: 0, the part's own)")
      .type_name("MARGIN[,TOP]");
  verb.add_option("--cell", options.cell, "Distance of dexels (default: " + cell_default + ")")
      .type_name("D");
  verb.add_option("--unit", options.unit, "Unit of the part: mm (default), cm, m, inch").type_name("NAME");
  verb.add_option("--control-point", options.control_point,
                  "What the path's coordinates are those of: tip (default) or centre (R above it)")
      .type_name("NAME");
}

Result<bool> steers_centre(const std::string& control_point) {
  if (!control_point.empty() && control_point != "tip" && control_point != "centre")
    return Error{ErrorCode::usage, "--control-point '" + control_point + "' is unknown", "", "give tip or centre"};
  return control_point == "centre";
}

Result<ProgramSetup> program_setup(const ProgramOptions& options) {
  const Result<Cutter> cutter = Cutter::parse(options.tool);
  if (!cutter) return cutter.error();
  Result<StockOptions> stock = parse_stock(options.stock);
  if (!stock) return stock.error();
  const Result<double> unit = parse_unit(options.unit);
  if (!unit) return unit.error();
  ProgramSetup setup{*cutter, *stock, *unit};
  const Result<bool> centre = steers_centre(options.control_point);
  if (!centre) return centre.error();
  setup.centre = *centre;
  if (!options.cell.empty()) {
    const Result<double> cell = parse_positive("--cell", options.cell);
    if (!cell) return cell.error();
    setup.stock.cell = *cell;
  }
  return setup;
}

Result<std::vector<Program>> read_programs(const ProgramOptions& options, const ProgramSetup& setup, Session& session) {
  std::vector<Program> programs;
  const auto read = [&](const std::string& path, const Cutter& cutter) -> Status {
    Result<input::GCodeFile> file = input::read_gcode(path, setup.millimetres, session.context("reading"));
    if (!file) {
      Error error = file.error();
      error.what = input_name(path) + ": " + error.what;
      return error;
    }
    for (const std::string& note : file->notes) session.note(input_name(path), note);
    lift(file->path, cutter, setup.centre);
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
  if (Status done = read(options.path, setup.cutter); !done) return done.error();
  return programs;
}

bool is_tool_path(const std::string& path) {
  const std::string extension = input::format_extension(path);
  return extension == "ngc" || extension == "nc" || extension == "gcode" || extension == "tap";
}

}  // namespace krepl::app
