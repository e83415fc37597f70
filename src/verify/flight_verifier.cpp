// Routes over a terrain.
#include <algorithm>
#include <cmath>

#include "verify/route_verifier.hpp"
#include "verify/solid.hpp"
#include "verify/tally.hpp"

namespace krepl::verify {

namespace {

constexpr std::uint64_t usual_samples = 1'000'000;
constexpr double fineness = 1e-3;  // of the radius: the least clearance is known so well

/// What is known of a stretch of the route.
struct Found {
  Tally keeps_away;
  double clearance = std::numeric_limits<double>::infinity();
  Point nearest;
  double unproven = 0;
  void add(const Found& other) {
    keeps_away.add(other.keeps_away);
    if (other.clearance < clearance) clearance = other.clearance, nearest = other.nearest;
    unproven = std::max(unproven, other.unproven);
  }
};

/// One straight stretch, halved until the ball about the middle of each part proves it.
class Stretch {
 public:
  Stretch(const Solid& solid, const RouteReport& report, double shortest, Found& found)
      : solid_(solid), report_(report), shortest_(shortest), found_(found) {}

  void check(Space<double> a, Space<double> b) {
    const Space<double> m = 0.5 * (a + b);
    const double half = double(root(square(b - a))) / 2;
    const double bound = std::max(report_.radius, found_.clearance);
    const double d = distance(m, bound + half);
    found_.keeps_away.add(report_.radius - d, report_.tolerance, {m.x + solid_.origin().x, m.y + solid_.origin().y});
    if (d < bound + half && d < found_.clearance)
      found_.clearance = d, found_.nearest = {m.x + solid_.origin().x, m.y + solid_.origin().y};
    // Nothing on the stretch is nearer than that.
    const double least = d - half;
    if (least >= report_.radius - report_.tolerance && least >= found_.clearance - fineness * report_.radius) return;
    // Once it is broken, only the worst place matters.
    const bool broken = found_.clearance < report_.radius - report_.tolerance;
    if (broken && least >= found_.clearance - fineness * report_.radius) return;
    if (half <= shortest_) {
      found_.unproven = std::max(found_.unproven, half);
      return;
    }
    check(a, m), check(m, b);
  }

  /// The distance from the solid if it is less than the limit.
  double distance(Space<double> p, double limit) const {
    const double d = solid_.distance(p, limit);
    return std::abs(d - report_.radius) > report_.tolerance ? d : solid_.distance_carefully(p, limit);
  }

 private:
  const Solid& solid_;
  const RouteReport& report_;
  double shortest_;
  Found& found_;
};

/// Heights and slopes; z is only known here.
void check_limits(const std::vector<Point3>& points, const RouteCheckOptions& options, RouteReport& report) {
  Tally below, slopes;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point3 p = points[i];
    below.add(p.z - options.ceiling, report.tolerance, {p.x, p.y});
    if (i == 0) continue;
    const Point3 q = points[i - 1];
    const double run = std::hypot(p.x - q.x, p.y - q.y), rise = std::abs(p.z - q.z);
    report.climb += std::max(0.0, p.z - q.z);
    if (run == 0 && (i == 1 || i + 1 == points.size())) continue;  // take-off or landing
    if (rise > 0) report.steepest = std::max(report.steepest, rise / run);
    slopes.add(std::isinf(options.max_slope) ? 0 : Real(rise) - Real(options.max_slope) * run, report.tolerance, {p.x, p.y});
  }
  if (std::isfinite(options.ceiling)) report.checks.push_back(below.check("below the ceiling", report.tolerance));
  if (std::isfinite(options.max_slope)) report.checks.push_back(slopes.check("no steeper than allowed", report.tolerance));
}

}  // namespace

Result<RouteReport> check_flight(const input::RouteRecord& route, const Terrain& terrain, const RouteCheckOptions& options,
                                 const Context& context) {
  if (!(std::isfinite(options.radius) && options.radius > 0))
    return Error{ErrorCode::usage, "the radius must be a finite positive number", "", ""};
  if (!route.in_space())
    return Error{ErrorCode::input, "the route has no heights", "", "over a terrain give a line with Z, or columns x,y,z"};
  const Solid solid(terrain);
  const std::vector<Point3>& points = route.points;
  RouteReport report;
  report.radius = options.radius, report.pieces = points.size() - 1, report.obstacles = solid.triangle_count();
  report.scale = std::max(options.radius, 2 * solid.half_extent());
  std::vector<Space<double>> places;
  for (const Point3& p : points) {
    const Space<double> local(Space<Real>{Real(p.x) - solid.origin().x, Real(p.y) - solid.origin().y, Real(p.z) - solid.origin().z});
    report.scale = std::max({report.scale, std::abs(local.x), std::abs(local.y), std::abs(local.z)});
    if (!places.empty()) report.length += double(root(square(local - places.back())));
    places.push_back(local);
  }
  report.tolerance = std::max(1e-9 * report.scale, 64 * solid.resolution()) + options.max_error;
  const double samples = double(options.samples > 0 ? options.samples : usual_samples);
  const double shortest = std::max(report.tolerance / 4, report.length / (2 * samples));

  const Found found = tally_all<Found>(context, places.size() - 1, [&](std::size_t i, Found& sum) {
    if (context.cancelled()) return;
    // For each stretch from the beginning: what is found must not depend on the order of the work.
    Found own;
    Stretch stretch(solid, report, shortest, own);
    for (const Space<double>& end : {places[i], places[i + 1]}) {
      const double d = stretch.distance(end, 4 * report.scale);
      const Point at{end.x + solid.origin().x, end.y + solid.origin().y};
      own.keeps_away.add(report.radius - d, report.tolerance, {at.x, at.y});
      if (d < own.clearance) own.clearance = d, own.nearest = at;
    }
    stretch.check(places[i], places[i + 1]);
    sum.add(own);
  });
  if (context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  report.clearance = found.clearance, report.nearest = found.nearest, report.unproven = found.unproven;
  Check free = found.keeps_away.check("the ball keeps away", report.tolerance);
  if (found.unproven == 0) free.note = "proven between the places too";
  report.checks.push_back(std::move(free));
  check_limits(points, options, report);
  if (route.clearance) {
    Tally told;
    const double allowed = report.tolerance + fineness * options.radius;
    told.add(*route.clearance - report.clearance, allowed, {report.nearest.x, report.nearest.y});
    report.checks.push_back(told.check("clearance as told", allowed));
  }
  return report;
}

}  // namespace krepl::verify
