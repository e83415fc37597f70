#include "verify/surface_verifier.hpp"

#include <algorithm>
#include <cmath>

#include "verify/surface_checks.hpp"

namespace krepl::verify {

namespace {

void shift(Point3& p, Point3 origin) { p = {p.x - origin.x, p.y - origin.y, p.z - origin.z}; }

/// Coordinates from the solid's origin. The file holds sums with it, rounded.
void make_relative(input::SubdivisionFile& file, Point3 origin) {
  for (auto& feature : file.features)
    for (Point3& p : feature.at) shift(p, origin);
  for (Point3& p : file.vertices) shift(p, origin);
  for (Point3& p : file.points) shift(p, origin);
}

std::uint64_t default_samples(std::size_t edges) { return std::clamp<std::uint64_t>(4 * edges, 20'000, 1'000'000); }

Check check_radius(double found, double asked, double resolution) {
  Check check;
  check.name = "radius";
  check.tested = 1;
  check.worst = std::abs(found - asked);
  check.limit = 4 * resolution;
  check.violations = check.worst <= check.limit ? 0 : 1;
  return check;
}

void run_checks(SurfaceCase& surface, SurfaceReport& report) {
  const Context& context = surface.context;
  const auto add = [&](const std::vector<Check>& checks) {
    report.checks.insert(report.checks.end(), checks.begin(), checks.end());
    if (context.progress) context.progress(double(report.checks.size()) / 16);
  };
  add({check_topology(surface)});
  if (!report.checks.back().ok()) return;  // the others take it for granted
  report.components = surface.components;
  add({check_labels(surface)});
  if (!context.cancelled()) add(check_edges(surface));
  if (!context.cancelled()) add({check_vertices(surface)});
  if (!context.cancelled()) add(check_embedding(surface, report.area));
  if (!context.cancelled()) add(check_samples(surface));
}

}  // namespace

Result<SurfaceReport> check_surface(input::SubdivisionFile file, const Terrain& terrain,
                                    const SurfaceCheckOptions& options, const Context& context) {
  if (!(std::isfinite(options.radius) && options.radius > 0))
    return Error{ErrorCode::usage, "the radius must be a finite positive number", "", ""};
  const Solid solid(terrain);
  make_relative(file, solid.origin());
  SurfaceReport report;
  report.radius = options.radius;
  report.scale = std::max(options.radius, solid.half_extent());
  report.tolerance = std::max(1e-9 * report.scale, 64 * solid.resolution());
  report.triangles = solid.triangle_count();
  report.vertices = file.vertices.size(), report.edges = file.edges.size(), report.faces = file.faces.size();
  SurfaceCase surface{file,
                      solid,
                      options.radius,
                      report.scale,
                      report.tolerance,
                      0,
                      options.seed,
                      context,
                      {},
                      {},
                      {},
                      {},
                      {},
                      {},
                      {},
                      0,
                      {},
                      {}};
  surface.samples = options.samples != 0 ? options.samples : default_samples(report.edges);
  for (const auto& feature : file.features) {
    surface.shape.push_back({feature.at, feature.count});
    surface.key.push_back(solid.key_of(surface.shape.back()));
  }
  for (std::size_t f = 1; f < file.faces.size(); ++f) report.holes += file.faces[f].feature == SurfaceCase::none;
  report.checks.push_back(
      check_radius(file.radius, options.radius, std::nextafter(options.radius, HUGE_VAL) - options.radius));
  run_checks(surface, report);
  if (context.cancelled()) return Error{ErrorCode::cancelled, "interrupted while checking", "", ""};
  for (Check& check : report.checks) check.where = {check.where.x + solid.origin().x, check.where.y + solid.origin().y};
  return report;
}

}  // namespace krepl::verify
