// What krepl view has in common for all results.
#include "view_page.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "ogr/spatial_reference.hpp"
#include "output/output_stream.hpp"
#include "verbs.hpp"

namespace krepl::app {

bool ViewOptions::has_surface_options() const {
  return !max_error.empty() || !terrain.request.crs.empty() || terrain.given_reading_option() != nullptr;
}

bool ViewOptions::has_program_options() const {
  return !program.tool.empty() || !program.before.empty() || !program.stock.empty() || !program.cell.empty() ||
         !program.unit.empty() || !program.control_point.empty();
}

std::string page_title(const ViewOptions& options) {
  return options.title.empty() ? std::filesystem::path(options.result).filename().string() : options.title;
}

std::string code_in(const std::string& crs_name) {
  const std::size_t begin = crs_name.rfind('(');
  if (begin == std::string::npos || crs_name.back() != ')') return crs_name;
  return crs_name.substr(begin + 1, crs_name.size() - begin - 2);
}

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

int write_page(const ViewOptions& options, const std::string& html, const std::string& contents, Session& session) {
  const std::string name = output_name(options.output);
  auto stream = output::OutputStream::open(options.output);
  if (!stream) return session.fail(name, stream.error());
  stream->write(html);
  if (Status written = stream->finish(); !written) return session.fail(name, written.error());
  session.summary(
      fmt::format("{}: {}, {:.1f} MB; open it in a browser", name, contents, static_cast<double>(html.size()) / 1e6),
      options.output == "-");
  return 0;
}

}  // namespace krepl::app
