// krepl verify: re-checks a result against its input by brute force.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

#include "feature_buffer.hpp"
#include "input/gcode_reader.hpp"
#include "input/geometry_source.hpp"
#include "input/profile_reader.hpp"
#include "input/result_file.hpp"
#include "input/subdivision_file.hpp"
#include "network_options.hpp"
#include "krepl/cutter.hpp"
#include "shape_options.hpp"
#include "terrain_options.hpp"
#include "tool_programs.hpp"
#include "verbs.hpp"
#include "verify_features.hpp"
#include "verify_route.hpp"
#include "verify/input_parts.hpp"
#include "verify/path_verifier.hpp"
#include "verify/profile_verifier.hpp"
#include "verify/surface_verifier.hpp"
#include "verify/zone_verifier.hpp"

namespace krepl::app {

namespace {

struct VerifyOptions {
  std::string result;
  verify::InputRequest input;
  std::string radius, max_error, tool, control_point, ceiling, max_slope;
  TerrainOptions terrain;
  ShapeArguments shape;
  bool bands = false;
  std::uint64_t samples = 0;
  FeatureOptions features;
};

struct ZoneOfRadius {
  std::vector<input::ResultPolygon> polygons;
  double inner = 0;  // where a band begins
};
/// By radius: a file may hold several zones, and a zone may be spread over several features.
using ZonesByRadius = std::map<double, ZoneOfRadius>;

/// What the asked-for radii and --bands say of zones that do not tell it themselves.
Status tell_bands(std::vector<input::ResultZone>& zones, std::vector<double> asked) {
  std::sort(asked.begin(), asked.end());
  const bool told = std::any_of(zones.begin(), zones.end(), [](const auto& zone) { return zone.radius.has_value(); });
  if (!told && zones.size() != asked.size())
    return Error{ErrorCode::usage, fmt::format("the result holds {} bands that do not tell their radii", zones.size()), "",
                 "give as many with --radius"};
  for (std::size_t i = 0; i < zones.size(); ++i) {
    if (!told) zones[i].radius = asked[i];
    if (zones[i].inner || !zones[i].radius) continue;
    const auto at = std::find(asked.begin(), asked.end(), *zones[i].radius);
    if (at == asked.end())
      return Error{ErrorCode::usage, "the result does not tell where its bands begin", "", "give all radii with --radius"};
    zones[i].inner = at == asked.begin() ? 0 : *(at - 1);
  }
  return std::monostate{};
}

Result<ZonesByRadius> group(std::vector<input::ResultZone> zones, const std::vector<double>& asked) {
  ZonesByRadius groups;
  for (input::ResultZone& zone : zones) {
    if (!zone.radius && asked.size() != 1)
      return Error{ErrorCode::usage, "the result does not tell its radius", "", "give one with --radius"};
    const double radius = zone.radius.value_or(asked.empty() ? 0 : asked[0]);
    if (!asked.empty() && std::find(asked.begin(), asked.end(), radius) == asked.end())
      return Error{ErrorCode::input,
                   fmt::format("the result holds a zone of radius {}, which --radius does not name", radius), "",
                   "give the radius that the result was made with"};
    auto& [polygons, inner] = groups[radius];
    inner = zone.inner.value_or(0);
    std::move(zone.polygons.begin(), zone.polygons.end(), std::back_inserter(polygons));
  }
  for (const double radius : asked)
    if (!groups.contains(radius))
      return Error{ErrorCode::input, fmt::format("the result holds no zone of radius {}", radius), "",
                   "check --radius"};
  return groups;
}

}  // namespace

Error violation(const char* what, double radius, const std::vector<verify::Check>& checks) {
  Error error{ErrorCode::computation, "", "", ""};
  for (const verify::Check& check : checks) {
    if (check.ok()) continue;
    if (!error.what.empty()) error.what += ", ";
    error.what += check.name;
    if (error.where.empty()) error.where = fmt::format("near {:.12g} {:.12g}", check.where.x, check.where.y);
  }
  error.what = fmt::format("is not the {} of radius {}: {}", what, radius, error.what);
  return error;
}

void print_checks(Session& session, const std::vector<verify::Check>& checks) {
  session.summary(
      fmt::format("{:<28} {:>9} {:>7} {:>10} {:>10}  {}", "check", "tested", "wrong", "worst", "allowed", "worst at"));
  for (const verify::Check& check : checks) {
    const bool placed = check.worst > 0 && check.name.find("area") == std::string::npos;
    std::string last = placed ? fmt::format("{:.12g} {:.12g}", check.where.x, check.where.y) : "";
    if (!check.note.empty()) last += (last.empty() ? "" : "; ") + check.note;
    session.summary(fmt::format("{:<28} {:>9} {:>7} {:>10.3g} {:>10.3g}  {}", check.name, check.tested,
                                check.violations, check.worst, check.limit, last));
  }
}

verify::ShapeQuestion shape_question(const ShapeOptions& shape, double radius) {
  verify::ShapeQuestion question;
  question.distance = radius, question.mitre_limit = shape.mitre_limit, question.ring = shape.ring;
  question.cap = verify::ShapeQuestion::Cap(shape.cap), question.join = verify::ShapeQuestion::Join(shape.join);
  question.side = verify::ShapeQuestion::Side(shape.side);
  return question;
}

double border_chords(const ShapeOptions& shape, double radius) { return shape.side != Side::both ? 2e-6 * radius : 0; }

namespace {

void print(Session& session, const verify::ZoneReport& report) {
  const std::string inner = report.inner > 0 ? fmt::format("{} to ", report.inner) : "";
  session.summary(fmt::format("{} of radius {}{}: {} polygons, {} holes, {} pieces, {} of them arcs",
                              report.inner > 0 ? "band" : "zone", inner, report.radius, report.polygons, report.holes, report.pieces, report.arcs));
  session.summary(fmt::format("area {:.15g}, length {:.15g}, S {:.6g}, tolerance {:.2g}", report.area, report.perimeter,
                              report.scale, report.tolerance));
  print_checks(session, report.checks);
}

void print(Session& session, const verify::ProfileReport& report) {
  session.summary(
      fmt::format("profile of radius {}: {} segments in, {} pieces out, {} of them arcs, {} explicit vertices",
                  report.radius, report.segments, report.pieces, report.arcs, report.explicit_vertices));
  session.summary(fmt::format("S {:.6g}, tolerance {:.2g}", report.scale, report.tolerance));
  print_checks(session, report.checks);
}

void print(Session& session, const verify::SurfaceReport& report) {
  session.summary(fmt::format(
      "surface of radius {}: {} triangles in, {} faces, {} edges, {} vertices, {} components, {} holes out",
      report.radius, report.triangles, report.faces, report.edges, report.vertices, report.components, report.holes));
  session.summary(fmt::format("area of the projection {:.12g}, S {:.6g}, tolerance {:.2g}", report.area, report.scale,
                              report.tolerance));
  print_checks(session, report.checks);
}

/// All polygons are one zone, whose radius is the largest of the features'.
ZonesByRadius as_one_zone(std::vector<input::ResultZone> zones, const std::vector<verify::InputPart>& parts) {
  double largest = 0;
  for (const verify::InputPart& part : parts) largest = std::max(largest, part.radius);
  ZonesByRadius all;
  for (input::ResultZone& zone : zones)
    std::move(zone.polygons.begin(), zone.polygons.end(), std::back_inserter(all[largest].polygons));
  return all;
}

int verify_zones(const VerifyOptions& options, Session& session) {
  std::vector<double> radii;
  const bool varied = !options.input.radius_field.empty() || !options.input.radius_expression.empty();
  if (!options.radius.empty() && !varied) {
    auto parsed = parse_signed_radii(options.radius);
    if (!parsed) return session.fail("", parsed.error());
    radii = std::move(*parsed);
  }
  verify::ZoneCheckOptions check;
  check.samples = options.samples;
  if (!options.max_error.empty()) {
    auto parsed = parse_positive("--max-error", options.max_error);
    if (!parsed) return session.fail("", parsed.error());
    check.max_error = *parsed;
  }
  auto shape = parse_shape(options.shape);
  if (!shape) return session.fail("", shape.error());
  const FeatureOptions& f = options.features;
  if (f.per_feature || !f.dissolve_by.empty() || !f.owner.empty())
    return verify_features({options.result, options.input, f, radii, *shape, check.max_error, options.samples}, session);
  auto zones = input::read_zones(options.result, input::EmptyZones::keep);
  if (!zones) return session.fail(options.result, zones.error());
  if (options.bands) {
    if (varied || !is_plain(*shape, radii))
      return session.fail("", {ErrorCode::usage, "bands have round caps and joins, both sides and positive radii", "",
                               "leave the other options out"});
    if (Status told = tell_bands(*zones, radii); !told) return session.fail(options.result, told.error());
  }
  verify::InputRequest request = options.input;
  request.keep_arcs = takes_arcs(*shape);
  auto parts = verify::read_parts(request, session.context("reading"));
  session.finish_progress();
  if (!parts) return session.fail(options.input.path, parts.error());
  Result<ZonesByRadius> groups =
      varied ? Result<ZonesByRadius>(as_one_zone(std::move(*zones), *parts)) : group(std::move(*zones), radii);
  if (!groups) return session.fail(options.result, groups.error());
  if (groups->empty()) return session.fail(options.result, {ErrorCode::input, "holds no zone", "", ""});

  const verify::Obstacle obstacle(*parts, groups->rbegin()->first);
  int status = 0;
  for (const auto& [radius, zone] : *groups) {
    check.radius = radius, check.inner = zone.inner;
    if (options.max_error.empty()) check.max_error = border_chords(*shape, radius);
    const bool plain = is_plain(*shape, {radius});
    if (!plain && zone.inner > 0)
      return session.fail("", {ErrorCode::usage, "bands have round caps and joins, both sides and positive radii", "",
                               "leave the other options out"});
    auto report = plain ? verify::check_zone(zone.polygons, obstacle, check, session.context("checking"))
                        : verify::check_shape(zone.polygons, *parts, shape_question(*shape, radius), check,
                                              session.context("checking"));
    session.finish_progress();
    if (!report) return session.fail(options.result, report.error());
    print(session, *report);
    if (report->ok()) continue;
    Error error = violation(zone.inner > 0 ? "band" : "zone", radius, report->checks);
    if (report->arcs == 0 && check.max_error == 0) error.remedy = "for a format without arcs give --max-error";
    status = session.fail(options.result, error);
  }
  if (status == 0) session.summary("sound: every check passed");
  return status;
}

int verify_profile(const VerifyOptions& options, Session& session) {
  if (options.radius.empty())
    return session.fail(options.result,
                        {ErrorCode::usage, "a profile does not tell its radius", "", "give it with --radius"});
  auto radius = parse_radius(options.radius);
  if (!radius) return session.fail("", radius.error());
  auto pieces = input::read_profile(options.result);
  if (!pieces) return session.fail(options.result, pieces.error());
  auto terrain = input::read_terrain_line({options.input.path, options.input.layer, options.input.where},
                                          session.context("reading"));
  session.finish_progress();
  if (!terrain) return session.fail(options.input.path, terrain.error());

  verify::ProfileCheckOptions check;
  check.radius = *radius, check.heights = options.samples;
  auto report = verify::check_profile(terrain->points, *pieces, check, session.context("checking"));
  session.finish_progress();
  if (!report) return session.fail(options.result, report.error());
  print(session, *report);
  if (!report->ok()) return session.fail(options.result, violation("profile", *radius, report->checks));
  session.summary("sound: every check passed");
  return 0;
}

int verify_surface(const VerifyOptions& options, Session& session) {
  verify::SurfaceCheckOptions check;
  check.samples = options.samples;
  if (!options.radius.empty()) {
    auto radius = parse_radius(options.radius);
    if (!radius) return session.fail("", radius.error());
    check.radius = *radius;
  }
  TerrainOptions terrain_options = options.terrain;
  terrain_options.request.path = options.input.path;
  terrain_options.request.crs = options.input.crs, terrain_options.request.to_crs = options.input.to_crs;
  auto request = terrain_request(terrain_options);
  if (!request) return session.fail("", request.error());
  auto terrain = input::read_terrain(*request, session.context("reading"));
  session.finish_progress();
  if (!terrain) return session.fail(options.input.path, terrain.error());
  auto file = input::read_subdivision(options.result, session.context("reading"));
  session.finish_progress();
  if (!file) return session.fail(options.result, file.error());

  if (options.radius.empty()) check.radius = file->radius;
  const double radius = check.radius;
  auto report = verify::check_surface(std::move(*file), *terrain->terrain, check, session.context("checking"));
  session.finish_progress();
  if (!report) return session.fail(options.result, report.error());
  print(session, *report);
  if (!report->ok()) return session.fail(options.result, violation("surface", radius, report->checks));
  session.summary("sound: every check passed");
  return 0;
}

/// The tool of --tool or the ball of --radius, and how far its centre is above the points of the path.
Status path_options(const VerifyOptions& options, verify::PathCheckOptions& check) {
  if (options.tool.empty() == options.radius.empty())
    return Error{ErrorCode::usage, "a tool path does not tell its tool", "", "give --tool, as ball:D or flat:D"};
  const Result<bool> centre = steers_centre(options.control_point);
  if (!centre) return centre.error();
  if (!options.tool.empty()) {
    const auto cutter = Cutter::parse(options.tool);
    if (!cutter) return cutter.error();
    check.radius = cutter->radius();
    if (cutter->kind() != Cutter::Kind::ball) check.cutter = *cutter;
    if (check.cutter && *centre)
      return Error{ErrorCode::usage, "tool '" + options.tool + "' has no centre", "", "give --control-point tip"};
  } else {
    const auto radius = parse_radius(options.radius);
    if (!radius) return radius.error();
    check.radius = *radius;
  }
  if (!options.max_error.empty()) {
    const auto parsed = parse_positive("--max-error", options.max_error);
    if (!parsed) return parsed.error();
    check.max_error = *parsed;
  }
  check.lift = *centre || check.cutter ? 0 : check.radius;
  check.samples = options.samples;
  return std::monostate{};
}

void print(Session& session, const verify::PathReport& report, const std::optional<Cutter>& cutter) {
  session.summary(fmt::format("tool path of {}: {} moves, length {:.9g}, against {} triangles",
                              cutter ? cutter->text() : fmt::format("a ball of radius {}", report.radius), report.moves,
                              report.length, report.triangles));
  session.summary(
      fmt::format("S {:.6g}, tolerance {:.2g}, a place every {:.3g}", report.scale, report.tolerance, report.step));
  print_checks(session, report.checks);
}

int verify_path(const VerifyOptions& options, Session& session) {
  verify::PathCheckOptions check;
  if (Status checked = path_options(options, check); !checked) return session.fail("", checked.error());
  TerrainOptions terrain_options = options.terrain;
  terrain_options.request.path = options.input.path;
  terrain_options.request.crs = options.input.crs, terrain_options.request.to_crs = options.input.to_crs;
  auto request = terrain_request(terrain_options);
  if (!request) return session.fail("", request.error());
  auto path = input::read_gcode(options.result, 1, session.context("reading"));
  session.finish_progress();
  if (!path) return session.fail(options.result, path.error());
  for (const std::string& note : path->notes) session.note(options.result, note);
  auto part = input::read_terrain(*request, session.context("reading"));
  session.finish_progress();
  if (!part) return session.fail(options.input.path, part.error());
  auto report = verify::check_path(path->path, *part->terrain, check, session.context("checking"));
  session.finish_progress();
  if (!report) return session.fail(options.result, report.error());
  print(session, *report, check.cutter);
  if (!report->ok()) return session.fail(options.result, violation("free path", check.radius, report->checks));
  session.summary("sound: every check passed");
  return 0;
}

int run_verify(const VerifyOptions& given, Session& session) {
  VerifyOptions options = given;
  if (is_radius_expression(options.radius)) options.input.radius_expression = options.radius;
  if (!options.radius.empty() && !options.input.radius_field.empty())
    return session.fail("", {ErrorCode::usage, "--radius and --radius-field exclude each other", "", "give one of them"});
  const std::string extension = input::format_extension(options.result);
  if (is_tool_path(options.result)) return verify_path(options, session);
  if (!options.tool.empty() || !options.control_point.empty())
    return session.fail("", {ErrorCode::usage, "--tool and --control-point belong to tool paths (.ngc)", "", ""});
  if (extension == "json" && input::looks_like_subdivision(options.result)) return verify_surface(options, session);
  if (input::looks_like_route(options.result))
    return verify_route({options.result, options.input, options.terrain, options.radius, options.max_error, options.ceiling,
                         options.max_slope, options.samples}, session);
  if (!options.ceiling.empty() || !options.max_slope.empty())
    return session.fail("", {ErrorCode::usage, "--ceiling and --max-slope belong to routes", "", ""});
  if (const char* name = options.terrain.given_reading_option())
    return session.fail("", {ErrorCode::usage, fmt::format("{} belongs to subdivisions (.json) and routes over a terrain", name), "", ""});
  return extension == "csv" ? verify_profile(options, session) : verify_zones(options, session);
}

}  // namespace

void add_verify_verb(Verb& program, Session& session) {
  auto options = std::make_shared<VerifyOptions>();
  Verb verb = program.add_verb("verify", "Re-check a result against its input by independent brute force");
  verb.add_option("RESULT", options->result,
                  "Zone or route (vector file, .csv), profile (.csv), subdivision (.json) or tool path (.ngc) to check")
      .required();
  verb.add_option("--against", options->input.path, "The input that the result was made from")
      .required()
      .type_name("IN");
  verb.add_option("--radius", options->radius, "Radius or radii, or an expression of the input's fields; may be left out where the result tells them")
      .type_name("R");
  verb.add_option("--radius-field", options->input.radius_field, "Field of the input that holds each feature's radius")
      .type_name("NAME");
  verb.add_flag("--per-feature", options->features.per_feature, "The result was made with --per-feature");
  verb.add_option("--dissolve-by", options->features.dissolve_by, "The result was made with --dissolve-by FIELD")
      .type_name("FIELD");
  verb.add_option("--owner", options->features.owner, "The result was made with --owner nearest").type_name("NAME");
  verb.add_option("--layer", options->input.layer, "Layer of the input").type_name("NAME");
  verb.add_option("--where", options->input.where, "Condition on the input's fields (OGR SQL)").type_name("SQL");
  verb.add_option("--crs", options->input.crs, "Coordinate system of the input, in place of its own")
      .type_name("CRS");
  verb.add_option("--to-crs", options->input.to_crs, "Projection that the result was made with")
      .type_name("CRS|auto");
  add_arc_option(verb, options->input.arc_error);
  verb.add_option("--samples", options->samples,
                  "Number of points whose membership is tested, or at which the ball is let down (default: some "
                  "seconds' worth)")
      .type_name("N");
  add_shape_options(verb, options->shape);
  verb.add_flag("--bands", options->bands, "The result was made with --bands: needed where it does not tell so (WKT, WKB)");
  verb.add_option("--max-error", options->max_error,
                  "Deviation allowed to a format without arcs, or depth to a tool path (default: none)")
      .type_name("E");
  verb.add_option("--tool", options->tool, "Tool paths: ball:D, flat:D, bull:D:CORNER_RADIUS, cone:D:ANGLE, taper:D:ANGLE:TIP_RADIUS").type_name("TOOL");
  verb.add_option("--control-point", options->control_point,
                  "Tool paths: what Z is the height of, tip (default) or centre")
      .type_name("NAME");
  verb.add_option("--ceiling", options->ceiling, "Routes over a terrain: height that the ball's centre must not exceed")
      .type_name("Z");
  verb.add_option("--max-slope", options->max_slope, "Routes over a terrain: largest rise over horizontal way allowed")
      .type_name("SLOPE");
  add_reading_options(verb, options->terrain, "As the terrain was read");
  session.add_common_options(verb);
  session.on_run(verb, [options, &session] { return run_verify(*options, session); });
}

}  // namespace krepl::app
