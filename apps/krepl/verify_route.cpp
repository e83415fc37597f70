// krepl verify of routes.
#include "verify_route.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>

#include "input/terrain_reader.hpp"
#include "route_options.hpp"
#include "verbs.hpp"
#include "verify_features.hpp"

namespace krepl::app {

namespace {

/// Radius, limits and what the route may lack; the radius is the file's own where none is given.
Result<verify::RouteCheckOptions> asked(const RouteVerification& job, const input::RouteRecord& route, bool over_terrain) {
  verify::RouteCheckOptions check;
  check.samples = job.samples;
  if (!job.radius.empty()) {
    const auto radius = parse_radius(job.radius);
    if (!radius) return radius.error();
    check.radius = *radius;
  } else if (route.radius) {
    check.radius = *route.radius;
  } else {
    return Error{ErrorCode::usage, "the route does not tell its radius", "", "give it with --radius"};
  }
  if (!job.max_error.empty()) {
    const auto parsed = parse_positive("--max-error", job.max_error);
    if (!parsed) return parsed.error();
    check.max_error = *parsed;
  }
  if (!over_terrain && (!job.ceiling.empty() || !job.max_slope.empty()))
    return Error{ErrorCode::usage, "--ceiling and --max-slope are for routes over a terrain", "", "leave them out"};
  if (!job.ceiling.empty()) {
    const auto [end, status] = std::from_chars(job.ceiling.data(), job.ceiling.data() + job.ceiling.size(), check.ceiling);
    if (status != std::errc{} || end != job.ceiling.data() + job.ceiling.size() || !std::isfinite(check.ceiling))
      return Error{ErrorCode::usage, "--ceiling '" + job.ceiling + "' is not a number", "", ""};
  }
  if (!job.max_slope.empty()) {
    const auto parsed = parse_positive("--max-slope", job.max_slope);
    if (!parsed) return parsed.error();
    check.max_slope = *parsed;
  }
  return check;
}

void print(Session& session, const verify::RouteReport& report, bool over_terrain) {
  session.summary(fmt::format("route of a {} of radius {}: {} pieces, length {:.12g}, against {} {}",
                              over_terrain ? "ball" : "disk", report.radius, report.pieces, report.length, report.obstacles,
                              over_terrain ? "triangles" : "segments and points"));
  session.summary(fmt::format("least clearance {:.12g} near {:.12g} {:.12g}, S {:.6g}, tolerance {:.2g}", report.clearance,
                              report.nearest.x, report.nearest.y, report.scale, report.tolerance));
  if (over_terrain) session.summary(fmt::format("climb {:.9g}, steepest {:.6g}", report.climb, report.steepest));
  if (report.unproven > 0)
    session.summary(fmt::format("between two places the ball can be nearer by up to {:.3g}; --samples for more of them", report.unproven));
  print_checks(session, report.checks);
}

Result<verify::RouteReport> over_terrain(const RouteVerification& job, const input::RouteRecord& route,
                                         const verify::RouteCheckOptions& check, Session& session) {
  TerrainOptions terrain = job.terrain;
  terrain.request.path = job.input.path, terrain.request.crs = job.input.crs, terrain.request.to_crs = job.input.to_crs;
  const auto request = terrain_request(terrain);
  if (!request) return request.error();
  const auto file = input::read_terrain(*request, session.context("reading"));
  session.finish_progress();
  if (!file) return file.error();
  return verify::check_flight(route, *file->terrain, check, session.context("checking"));
}

Result<verify::RouteReport> in_plane(const RouteVerification& job, const input::RouteRecord& route,
                                     const verify::RouteCheckOptions& check, Session& session) {
  const auto parts = verify::read_parts(job.input, session.context("reading"));
  session.finish_progress();
  if (!parts) return parts.error();
  return verify::check_route(route, *parts, check, session.context("checking"));
}

}  // namespace

int verify_route(const RouteVerification& job, Session& session) {
  const auto route = input::read_route(job.result);
  if (!route) return session.fail(job.result, route.error());
  const bool terrain = is_terrain(job.input.path);
  const auto check = asked(job, *route, terrain);
  if (!check) return session.fail(job.result, check.error());
  const auto report = terrain ? over_terrain(job, *route, *check, session) : in_plane(job, *route, *check, session);
  session.finish_progress();
  if (!report) return session.fail(job.input.path, report.error());
  print(session, *report, terrain);
  if (report->ok()) {
    session.summary("sound: every check passed");
    return 0;
  }
  Error error = violation("free route", check->radius, report->checks);
  bool arcs = terrain;
  for (const input::ResultPiece& piece : route->pieces) arcs = arcs || piece.arc;
  if (!arcs && check->max_error == 0) error.remedy = "for a format without arcs give --max-error";
  return session.fail(job.result, error);
}

}  // namespace krepl::app
