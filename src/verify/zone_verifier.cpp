#include "verify/zone_verifier.hpp"

#include <algorithm>
#include <cmath>

#include "verify/zone_checks.hpp"

namespace krepl::verify {

namespace {

bool finite(Point p) { return std::isfinite(p.x) && std::isfinite(p.y); }

bool finite(const input::ResultRing& ring) {
  return std::all_of(ring.pieces.begin(), ring.pieces.end(), [](const input::ResultPiece& piece) {
    return finite(piece.start) && finite(piece.end) && (!piece.arc || finite(piece.middle));
  });
}

bool finite(const std::vector<input::ResultPolygon>& polygons) {
  return std::all_of(polygons.begin(), polygons.end(), [](const input::ResultPolygon& polygon) {
    return finite(polygon.outer) &&
           std::all_of(polygon.holes.begin(), polygon.holes.end(), [](const auto& hole) { return finite(hole); });
  });
}

/// Enough points to find faults, few enough to end in a minute on a million pieces.
std::uint64_t default_samples(std::size_t pieces, double effort) {
  return std::uint64_t(effort * double(std::clamp<std::size_t>(4 * pieces, 20'000, 1'000'000))) + 1;
}

}  // namespace

Result<MeasuredZone> measure(const std::vector<input::ResultPolygon>& polygons, const Obstacle& obstacle,
                             const ZoneCheckOptions& options) {
  if (!(std::isfinite(options.radius) && options.radius > 0))
    return Error{ErrorCode::usage, "the radius must be a finite positive number", "", ""};
  if (!(options.inner >= 0 && options.inner < options.radius))
    return Error{ErrorCode::usage, "the inner radius of a band must be below its radius", "", ""};
  if (obstacle.segments().items().empty()) return Error{ErrorCode::input, "the input holds no line or point", "", ""};
  if (!finite(polygons)) return Error{ErrorCode::input, "the result has a coordinate that is not finite", "", ""};

  ZoneReport report;
  report.radius = options.radius, report.inner = options.inner;
  report.scale = double(std::max(Real(options.radius), obstacle.extent()));
  // What the contract promises, unless the coordinates themselves cannot express it.
  report.tolerance = double(std::max(Real(1e-9L) * report.scale, 64 * obstacle.resolution()));
  Boundary boundary(polygons, obstacle,
                    {options.radius, report.tolerance, options.inner, options.along, options.beyond});
  report.area = double(boundary.area());
  report.perimeter = double(boundary.perimeter());
  report.polygons = polygons.size();
  report.holes = boundary.rings().size() - polygons.size();
  report.pieces = boundary.curves().items().size();
  report.arcs = boundary.arc_fit().arcs;
  const auto samples = options.samples != 0 ? options.samples : default_samples(report.pieces, options.effort);
  return MeasuredZone{std::move(report), std::move(boundary), samples};
}

ZoneCase case_of(const MeasuredZone& measured, const Obstacle& obstacle, const ZoneCheckOptions& options,
                 const Context& context) {
  const Real tolerance = measured.report.tolerance;
  return {obstacle,        measured.boundary, options.radius, options.inner, tolerance, tolerance + options.max_error,
          measured.samples, options.effort,    options.seed,   context};
}

Result<ZoneReport> check_zone(const std::vector<input::ResultPolygon>& polygons, const Obstacle& obstacle,
                              const ZoneCheckOptions& options, const Context& context) {
  const auto measured = measure(polygons, obstacle, options);
  if (!measured) return measured.error();
  ZoneReport report = measured->report;
  const ZoneCase zone = case_of(*measured, obstacle, options, context);
  const auto add = [&](const Check& check) {
    report.checks.push_back(check);
    if (context.progress) context.progress(double(report.checks.size()) / 9);
  };
  for (auto* check : {check_joins, check_centres, check_distances, check_membership, check_coverage, check_crossings,
                      check_nesting}) {
    if (context.cancelled()) break;
    add(check(zone));
  }
  if (!context.cancelled())
    for (const Check& check : check_areas(zone)) add(check);
  if (context.cancelled()) return Error{ErrorCode::cancelled, "interrupted while checking", "", ""};
  return report;
}

}  // namespace krepl::verify
