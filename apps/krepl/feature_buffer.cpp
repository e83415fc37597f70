// krepl buffer with a radius of each feature, a zone of each feature or of each value of a field, and owners.
#include "feature_buffer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "feature_zones.hpp"
#include "input/feature_reader.hpp"
#include "krepl/curve_zone.hpp"
#include "krepl/zone.hpp"
#include "output/feature_file.hpp"
#include "shape_options.hpp"
#include "stopwatch.hpp"

namespace krepl::app {

namespace {

Error usage(const std::string& what, const std::string& remedy) { return {ErrorCode::usage, what, "", remedy}; }

Status check_options(const FeatureJob& job) {
  const FeatureOptions& f = job.features;
  const bool own_radius = !f.radius_field.empty() || is_radius_expression(job.radius);
  const bool grouped = f.per_feature || !f.dissolve_by.empty() || !f.owner.empty();
  if (!f.radius_field.empty() && !job.radius.empty())
    return usage("--radius and --radius-field exclude each other", "give one of them");
  if (f.radius_field.empty() && job.radius.empty()) return usage("--radius is required", "see `krepl buffer --help`");
  if (f.per_feature && !f.dissolve_by.empty())
    return usage("--per-feature and --dissolve-by exclude each other", "give one of them");
  if (!f.owner.empty() && f.owner != "nearest") return usage("--owner '" + f.owner + "' is unknown", "give --owner nearest");
  if (!f.owner.empty() && own_radius)
    return usage("--owner nearest needs one radius for all features", "give a number with --radius");
  const char* engine = f.owner.empty() ? "intervals" : "voronoi";
  if (job.engine != "auto" && job.engine != engine)
    return usage("engine '" + job.engine + "' does not do this", std::string("give --engine ") + engine);
  if (grouped && job.file.separate)
    return usage("--separate does not go with a zone for each feature or group", "leave it out");
  if (grouped && !output::holds_features(job.format))
    return usage("format " + job.format.name + " holds no features", "choose gpkg, fgb, geojson, shp, wkt or wkb");
  return std::monostate{};
}

/// Shapes other than the round zone have one radius each, and are not shared out.
Status check_shape(const FeatureJob& job, const std::vector<double>& radii) {
  const FeatureOptions& f = job.features;
  if (is_plain(job.shape, radii)) return std::monostate{};
  if (!f.owner.empty())
    return usage("owners share round zones of positive radii only", "leave caps, joins, sides and rings out");
  if (radii.empty() && !f.per_feature)
    return usage("zones of features with radii of their own are round where they share one", "give --per-feature, or one radius");
  return std::monostate{};
}

/// One dissolved zone whose features have radii of their own.
template <class AnyNetwork>
int write_dissolved(const FeatureJob& job, const input::FeatureData& data, Session& session, Stopwatch& total) {
  typename AnyNetwork::Builder builder;
  std::vector<double> radii;
  add_features(data, all_features(data), builder, radii);
  Result<AnyNetwork> network = std::move(builder).build(session.context("reading"));
  const std::string in_name = input_name(job.input.path), out_name = output_name(job.output);
  if (!network) return session.fail(in_name, network.error());
  Result<Zone> zone =
      compute_zone(std::make_shared<const AnyNetwork>(std::move(*network)), radii, session.context("computing"));
  if (!zone) return session.fail(in_name, zone.error());
  auto report = output::write_zones(job.output, {&*zone, 1}, job.format, job.file, session.context("writing"));
  if (!report) return session.fail(out_name, report.error());
  tell(*report, job, session);
  std::size_t arcs = 0;
  for (std::uint32_t e = 0; e < zone->piece_count(); ++e) arcs += zone->piece(e).kind == Zone::Kind::arc ? 1 : 0;
  session.summary(fmt::format("{} features; radii {} to {}: {} rings, {} holes, {} arcs, area {:.10g}; {:.3f} s", data.size(),
                              zone->least_radius(), zone->radius(), zone->ring_count(), zone->hole_count(), arcs,
                              zone->area(), total.seconds()),
                  job.output == "-");
  return 0;
}

/// Shapes depend on what is inside of polygons, so what is wrong with their rings is told.
template <class AnyNetwork>
Status tell_faults(const input::FeatureData& data, const std::string& in_name, Session& session) {
  if (std::ranges::find(data.parts.kind, input::Parts::Kind::ring) == data.parts.kind.end()) return std::monostate{};
  typename AnyNetwork::Builder builder;
  std::vector<double> radii;
  add_features(data, all_features(data), builder, radii);
  const Result<AnyNetwork> network = std::move(builder).build(session.context("reading"));
  if (!network) return std::monostate{};  // errors are told group by group
  return tell_ring_faults(*network, in_name, session);
}

}  // namespace

bool is_radius_expression(const std::string& text) {
  if (parse_signed_radii(text)) return false;
  const std::size_t first = text.find_first_not_of(" +-");
  if (first == text.npos) return false;
  const auto is_letter = [](unsigned char c) { return std::isalpha(c) || c == '"' || c == '_'; };
  return std::any_of(text.begin(), text.end(), is_letter) && text.find_first_of("+-*/()%|<>\"", first) != text.npos;
}

bool needs_features(const FeatureOptions& f, const std::string& radius) {
  return f.per_feature || !f.radius_field.empty() || !f.dissolve_by.empty() || !f.owner.empty() || radius.empty() ||
         is_radius_expression(radius);
}

void add_feature_options(Verb& verb, FeatureOptions& options) {
  verb.add_option("--radius-field", options.radius_field, "In place of --radius: field that holds each feature's radius")
      .type_name("NAME");
  verb.add_flag("--per-feature", options.per_feature, "A zone for each feature, with the feature's attributes");
  verb.add_option("--dissolve-by", options.dissolve_by, "A zone for each value of this field").type_name("FIELD");
  verb.add_option("--owner", options.owner,
                  "nearest: zones of features (or groups) do not overlap, each place belongs to the nearest")
      .type_name("NAME");
}

void tell(const output::ZoneFileReport& report, const FeatureJob& job, Session& session) {
  const std::string out_name = output_name(job.output);
  for (const std::string& note : report.notes) session.note(out_name, note);
  if (report.deviation && !job.features.owner.empty()) {
    session.note(out_name, fmt::format("note: chords deviate from the true borders by {:.6g} at most", *report.deviation));
  } else if (report.deviation) {
    session.note(out_name, fmt::format("note: {} has no arcs; the polygons deviate from the true zone by {:.6g} at most",
                                       job.format.name, *report.deviation));
  }
}

int run_feature_buffer(const FeatureJob& job, Session& session) {
  Stopwatch total;
  if (Status checked = check_options(job); !checked) return session.fail("", checked.error());
  input::FeatureRequest request{job.input, job.features.radius_field, "", job.features.dissolve_by};
  std::vector<double> radii;
  if (is_radius_expression(job.radius)) {
    request.radius_expression = job.radius;
  } else if (!job.radius.empty()) {
    Result<std::vector<double>> parsed = parse_signed_radii(job.radius);
    if (!parsed) return session.fail("", parsed.error());
    radii = std::move(*parsed);
  }
  if (Status checked = check_shape(job, radii); !checked) return session.fail("", checked.error());
  request.network.keep_arcs = job.engine == "auto" && groups_take_arcs(job.features, job.shape);
  const std::string in_name = input_name(job.input.path);
  Result<input::FeatureData> data = input::read_features(request, session.context("reading"));
  if (!data) return session.fail(in_name, data.error());
  for (const std::string& note : data->notes) session.note(in_name, note);

  FeatureJob with_crs = job;
  with_crs.file.crs = data->crs;
  const FeatureOptions& f = job.features;
  if (!f.per_feature && f.dissolve_by.empty() && f.owner.empty()) {
    return data->parts.middle.empty() ? write_dissolved<Network>(with_crs, *data, session, total)
                                      : write_dissolved<CurveNetwork>(with_crs, *data, session, total);
  }
  if (!is_plain(job.shape, radii)) {
    const Status told = data->parts.middle.empty() ? tell_faults<Network>(*data, in_name, session)
                                                   : tell_faults<CurveNetwork>(*data, in_name, session);
    if (!told) return session.fail(in_name, told.error());
  }
  const auto groups = make_groups(*data, f.dissolve_by);
  const GroupJob all{with_crs, *data, groups, radii};
  return f.owner.empty() ? write_groups(all, session) : write_owners(all, session);
}

}  // namespace krepl::app
