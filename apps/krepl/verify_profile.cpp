#include "verify_profile.hpp"

#include <fmt/format.h>

#include "input/profile_reader.hpp"
#include "verify/profile_verifier.hpp"

namespace krepl::app {

namespace {

void print(Session& session, const verify::ProfileReport& report) {
  session.summary(fmt::format("profile of radius {}: {} segments, {} pieces, {} of them arcs, {} explicit vertices", report.radius,
                              report.segments, report.pieces, report.arcs, report.explicit_vertices));
  session.summary(fmt::format("S {:.6g}, tolerance {:.2g}", report.scale, report.tolerance));
  session.summary(fmt::format("{:<30} {:>9} {:>7} {:>10} {:>10}  {}", "check", "tested", "wrong", "worst", "allowed", "worst at"));
  for (const verify::Check& check : report.checks) {
    const bool placed = check.worst > 0 || !check.ok();
    std::string last = placed ? fmt::format("{:.12g} {:.12g}", check.where.x, check.where.y) : "";
    if (!check.note.empty()) last += (last.empty() ? "" : "; ") + check.note;
    session.summary(fmt::format("{:<30} {:>9} {:>7} {:>10.3g} {:>10.3g}  {}", check.name, check.tested, check.violations,
                                check.worst, check.limit, last));
  }
}

Error violation(const verify::ProfileReport& report) {
  Error error{ErrorCode::computation, "", "", ""};
  for (const verify::Check& check : report.checks) {
    if (check.ok()) continue;
    error.what += (error.what.empty() ? "" : ", ") + check.name;
    if (error.where.empty()) error.where = fmt::format("near {:.12g} {:.12g}", check.where.x, check.where.y);
  }
  error.what = fmt::format("is not the profile of radius {}: {}", report.radius, error.what);
  return error;
}

}  // namespace

int verify_profile(const std::string& result, const verify::InputRequest& input, const std::string& radius, Session& session) {
  if (radius.empty())
    return session.fail("", {ErrorCode::usage, "a profile does not tell its radius", "", "give it with --radius"});
  if (!input.crs.empty() || !input.to_crs.empty())
    return session.fail("", {ErrorCode::usage, "--crs and --to-crs are not for profiles", "", "leave them out"});
  verify::ProfileCheckOptions options;
  const Result<double> parsed = parse_radius(radius);
  if (!parsed) return session.fail("", parsed.error());
  options.radius = *parsed;
  const auto pieces = input::read_profile(result);
  if (!pieces) return session.fail(result, pieces.error());
  const auto terrain = input::read_terrain({input.path, input.layer, input.where}, session.context("reading"));
  if (!terrain) return session.fail(input.path, terrain.error());
  const auto report = verify::check_profile(terrain->points, *pieces, options, session.context("checking"));
  session.finish_progress();
  if (!report) return session.fail(result, report.error());
  print(session, *report);
  if (!report->ok()) return session.fail(result, violation(*report));
  session.summary("sound: every check passed");
  return 0;
}

}  // namespace krepl::app
