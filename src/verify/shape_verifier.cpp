// Checks of zones of other shapes: the boundary, and places anywhere, against the definition.
#include <atomic>
#include <cmath>
#include <string>

#include "verify/shape_oracle.hpp"
#include "verify/zone_checks.hpp"

namespace krepl::verify {

namespace {

using Answer = ShapeOracle::Answer;

/// A bound of how far p is from a place where inside and outside meet, within a factor of 2 where it is far. Cusps may
/// be much narrower than the tolerance, so the places looked at come closer and closer.
Real distance_of_border(const ShapeOracle& oracle, Vec p, Real tolerance, Real most) {
  for (Real r = tolerance; r > 1e-7L * tolerance; r /= 4)
    if (oracle.around(p, r) == Answer::unclear) return tolerance / 2;
  Real far = 2 * tolerance;
  while (far < most && oracle.around(p, far) != Answer::unclear) far *= 2;
  return far;
}

/// True where sides of the input meet: if they touch, what is between them is narrower than any circle of places shows.
bool sides_meet(const Obstacle& obstacle, Vec p, Real tolerance) {
  std::size_t count = 0;
  Box around;
  around.add(p);
  const auto& segments = obstacle.segments();
  segments.for_each_in(around.grown(tolerance),
                       [&](std::uint32_t i) { count += segments.items()[i].distance(p) <= tolerance; });
  return count > 1;
}

Check check_boundary(const ZoneCase& zone, const ShapeOracle& oracle, const ShapeQuestion& question) {
  const auto& curves = zone.boundary.curves().items();
  const std::size_t inner = per_item(curves.size(), 1e5, 3, 32, zone.effort);
  const Tally tally = tally_all(zone.context, curves.size(), [&](std::size_t i, Tally& t) {
    for (std::size_t k = 1; k <= inner; ++k) {
      const Vec p = curves[i].at(Real(k) / Real(inner + 1));
      if (question.ring && sides_meet(zone.obstacle, p, zone.tolerance)) continue;
      t.add(distance_of_border(oracle, p, zone.deviation, 4 * zone.radius), zone.deviation, p);
    }
  });
  Check check = tally.check("distance of the boundary", zone.deviation);
  check.note = "bounds, no distances";
  return check;
}

Check check_places(const ZoneCase& zone, const ShapeOracle& oracle) {
  Box region = zone.obstacle.box();
  if (!zone.boundary.box().empty()) region.add(zone.boundary.box());
  region = region.grown(zone.radius / 2);
  std::atomic<std::uint64_t> unclear{0};
  const Tally tally = tally_all(zone.context, zone.samples, [&](std::size_t i, Tally& t) {
    const Vec p = sample_point(zone, region, i);
    const Answer answer = oracle.around(p, zone.deviation);
    if (answer == Answer::unclear) {
      unclear.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    const bool right = zone.boundary.winding(p) == (answer == Answer::inside ? 1 : 0);
    const Real off = right ? 0 : zone.boundary.curves().nearest(p).distance;
    t.add(right ? 0 : off > 0 && off < HUGE_VALL ? off : zone.radius, 0, p);
  });
  Check check = tally.check("membership of points", 0);
  if (unclear > 0) check.note = std::to_string(unclear.load()) + " too near the boundary to tell";
  return check;
}

}  // namespace

Result<ZoneReport> check_shape(const std::vector<input::ResultPolygon>& polygons, const std::vector<InputPart>& parts,
                               const ShapeQuestion& question, const ZoneCheckOptions& asked, const Context& context) {
  ZoneCheckOptions options = asked;
  options.radius = std::abs(question.distance);
  options.along = question.ring;
  options.beyond = question.cap != ShapeQuestion::Cap::round || question.join != ShapeQuestion::Join::round;
  const Obstacle obstacle(parts);
  const auto measured = measure(polygons, obstacle, options);
  if (!measured) return measured.error();
  ZoneReport report = measured->report;
  report.radius = question.distance;
  const ZoneCase zone = case_of(*measured, obstacle, options, context);
  const ShapeOracle oracle(parts, obstacle, question);
  const auto add = [&](const Check& check) {
    report.checks.push_back(check);
    if (context.progress) context.progress(double(report.checks.size()) / 6);
  };
  add(check_joins(zone));
  add(check_centres(zone));
  if (!context.cancelled()) add(check_boundary(zone, oracle, question));
  if (!context.cancelled()) add(check_places(zone, oracle));
  if (!context.cancelled()) add(check_crossings(zone));
  if (!context.cancelled()) add(check_nesting(zone));
  if (context.cancelled()) return Error{ErrorCode::cancelled, "interrupted while checking", "", ""};
  return report;
}

}  // namespace krepl::verify
