#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "input/network_reader.hpp"
#include "krepl/offset.hpp"
#include "output/offset_file.hpp"
#include "network_options.hpp"
#include "output_target.hpp"
#include "stopwatch.hpp"
#include "verbs.hpp"

namespace krepl::app {

namespace {

struct OffsetVerbOptions {
  input::NetworkRequest input;
  std::string output, distance, max_error, format;
};

/// One or more signed distances separated by commas.
Result<std::vector<double>> parse_distances(std::string_view text) {
  std::vector<double> distances;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view one = text.substr(begin, end - begin), digits = one.starts_with('+') ? one.substr(1) : one;
    double value = 0;
    const auto [last, status] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool number = status == std::errc{} && last == digits.data() + digits.size();
    if (!number || !std::isfinite(value) || value == 0) {
      return Error{
          ErrorCode::usage,
          fmt::format("--distance '{}' is {}", one, number && value == 0 ? "zero" : "not a finite number"), "",
          "give numbers above zero (left, outwards) or below (right, inwards), in the unit of the coordinates"};
    }
    distances.push_back(value);
    begin = end + 1;
  }
  return distances;
}

int run_offset(const OffsetVerbOptions& options, Session& session) {
  Stopwatch total;
  Result<std::vector<double>> distances = parse_distances(options.distance);
  if (!distances) return session.fail("", distances.error());
  output::OffsetFileOptions file;
  if (!options.max_error.empty()) {
    Result<double> max_error = parse_positive("--max-error", options.max_error);
    if (!max_error) return session.fail("", max_error.error());
    file.max_error = *max_error;
  }
  Result<output::ZoneFormat> format = output::find_zone_format(options.output, options.format);
  if (!format) return session.fail(options.output, format.error());
  if (Status target = check_target(options.output, {options.input.path}); !target)
    return session.fail(options.output, target.error());

  const std::string in_name = input_name(options.input.path), out_name = output_name(options.output);
  Result<input::NetworkData> data = input::read_network(options.input, session.context("reading"));
  if (!data) return session.fail(in_name, data.error());
  for (const std::string& note : data->notes) session.note(in_name, note);

  std::vector<output::OffsetSet> sets;
  std::string found;
  for (double distance : *distances) {
    Result<std::vector<OffsetCurve>> curves = offset_curves(*data->network, distance, session.context("computing"));
    if (!curves) return session.fail(in_name, curves.error());
    double length = 0;
    for (const OffsetCurve& curve : *curves) length += curve.length;
    found += fmt::format("distance {}: {} curves, length {:.10g}; ", distance, curves->size(), length);
    sets.push_back({distance, std::move(*curves)});
  }
  file.crs = data->crs;
  auto report = output::write_offsets(options.output, sets, *data->network, *format, file, session.context("writing"));
  if (!report) return session.fail(out_name, report.error());
  for (const std::string& note : report->notes) session.note(out_name, note);
  if (report->deviation) {
    session.note(out_name, fmt::format("note: {} has no arcs; the lines deviate from the true curves by {:.6g} at most",
                                       format->name, *report->deviation));
  }
  session.summary(fmt::format("{}{:.3f} s", found, total.seconds()), options.output == "-");
  return 0;
}

}  // namespace

void add_offset_verb(Verb& program, Session& session) {
  auto options = std::make_shared<OffsetVerbOptions>();
  Verb verb = program.add_verb(
      "offset", "Parallel curves of lines and polygon borders at signed distances, as true arcs");
  verb.add_option("IN", options->input.path,
                  "Vector file: any OGR format, .wkt (a geometry a line), .wkb, .gz of them, or -")
      .required();
  verb.add_option("OUT", options->output,
                  "Result: .gpkg .fgb .wkt .wkb (curves), .svg .dxf (arcs), .geojson .shp ... (chords), or -")
      .required();
  verb.add_option(
          "--distance", options->distance,
          "Above zero: left of lines, outwards from polygons; below: right, inwards; in the unit of the coordinates")
      .required()
      .type_name("D[,D2,...]");
  add_network_options(verb, options->input, options->format);
  verb.add_option("--max-error", options->max_error,
                  "Formats without arcs: largest deviation (default: distance / 1000)")
      .type_name("LENGTH");
  session.add_common_options(verb);
  session.on_run(verb, [options, &session] { return run_offset(*options, session); });
}

}  // namespace krepl::app
