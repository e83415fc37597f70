#include "verify/route_verifier.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "verify/boundary.hpp"
#include "verify/tally.hpp"

namespace krepl::verify {

namespace {

constexpr double parabola_error = 1e-3;  // of the radius: chords that krepl route writes

/// The circle through an arc's three points, relative to the middle one so that large coordinates cost no digits; points on one
/// line are a segment.
Curve curve_of(const input::ResultPiece& piece) {
  Curve curve;
  curve.a = piece.start, curve.b = piece.end;
  if (!piece.arc) return curve;
  const Vec m(piece.middle), u = curve.a - m, v = curve.b - m;
  const Real twice = 2 * cross(u, v);
  if (piece.start.x == piece.end.x && piece.start.y == piece.end.y) {  // a full circle
    curve.arc = true, curve.c = m + Real(0.5) * u, curve.r = length(u) / 2;
    curve.sweep = 2 * std::numbers::pi_v<Real>;
    return curve;
  }
  if (twice == 0) return curve;
  const Real uu = dot(u, u), vv = dot(v, v);
  const Vec c((v.y * uu - u.y * vv) / twice, (u.x * vv - v.x * uu) / twice);
  curve.arc = true, curve.c = m + c, curve.r = length(c);
  const Vec from = curve.a - curve.c, to = curve.b - curve.c;
  const Real turn = std::atan2(cross(from, to), dot(from, to)), whole = 2 * std::numbers::pi_v<Real>;
  // The three points turn left where the arc does.
  const bool left = cross(m - curve.a, curve.b - m) > 0;
  curve.sweep = left ? (turn > 0 ? turn : turn + whole) : (turn < 0 ? turn : turn - whole);
  return curve;
}

Real square(Real x) { return x * x; }

bool segments_cross(Vec a, Vec b, Vec p, Vec q) {
  const auto side = [](Vec o, Vec u, Vec v) { return cross(u - o, v - o); };
  const Real d1 = side(a, b, p), d2 = side(a, b, q), d3 = side(p, q, a), d4 = side(p, q, b);
  return ((d1 > 0) != (d2 > 0)) && ((d3 > 0) != (d4 > 0));
}

/// Distance between a piece of the route and a segment p q, and the place of the centre where it is reached.
struct Nearest {
  Real distance = HUGE_VALL;
  Vec centre;
  void offer(Real d, Vec at) {
    if (d < distance) distance = d, centre = at;
  }
};

Vec foot_on(Vec p, Vec a, Vec b) {
  const Vec d = b - a;
  const Real t = dot(p - a, d), whole = dot(d, d);
  return !(t > 0) ? a : t >= whole ? b : a + (t / whole) * d;
}

Nearest segment_to_segment(const Curve& way, Vec p, Vec q) {
  Nearest nearest;
  if (segments_cross(way.a, way.b, p, q))
    nearest.offer(0, way.a + (cross(p - way.a, q - p) / cross(way.b - way.a, q - p)) * (way.b - way.a));
  nearest.offer(distance_to_segment(way.a, p, q), way.a);
  nearest.offer(distance_to_segment(way.b, p, q), way.b);
  for (const Vec& v : {p, q}) nearest.offer(distance_to_segment(v, way.a, way.b), foot_on(v, way.a, way.b));
  return nearest;
}

/// The nearest point of an arc lies at one of its ends, in the direction of an end of the segment or of the foot of the centre on
/// it, or where they cross.
Nearest arc_to_segment(const Curve& way, Vec p, Vec q) {
  Nearest nearest;
  nearest.offer(distance_to_segment(way.a, p, q), way.a);
  nearest.offer(distance_to_segment(way.b, p, q), way.b);
  const auto towards = [&](Vec v) {
    const Vec d = v - way.c;
    const Real l = length(d);
    // At the centre itself all of the arc is as near; its ends have been asked.
    if (l == 0) return;
    if (way.sweeps(d)) nearest.offer(std::abs(l - way.r), way.c + (way.r / l) * d);
  };
  const Vec foot = foot_on(way.c, p, q);
  towards(p), towards(q), towards(foot);
  const Vec d = q - p;
  const Real dd = dot(d, d);
  if (dd == 0) return nearest;
  const Real h = cross(d, way.c - p) / std::sqrt(dd);
  if (std::abs(h) > way.r) return nearest;
  const Real along = dot(way.c - p, d) / dd, half = std::sqrt(square(way.r) - square(h)) / std::sqrt(dd);
  for (const Real t : {along - half, along + half}) {
    const Vec at = p + t * d;
    if (t >= 0 && t <= 1 && way.sweeps(at - way.c)) nearest.offer(0, at);
  }
  return nearest;
}

/// A box in double precision, grown by rounding: only to pass over pairs that are far apart.
struct Bounds {
  double x0, y0, x1, y1;
  explicit Bounds(const Box& b) {
    const double infinity = std::numeric_limits<double>::infinity();
    x0 = std::nextafter(double(b.x0), -infinity), y0 = std::nextafter(double(b.y0), -infinity);
    x1 = std::nextafter(double(b.x1), infinity), y1 = std::nextafter(double(b.y1), infinity);
  }
  double apart(const Bounds& b) const {
    const double dx = std::max({0.0, b.x0 - x1, x0 - b.x1}), dy = std::max({0.0, b.y0 - y1, y0 - b.y1});
    return std::max(dx, dy);
  }
};

struct Obstacles {
  std::vector<Obstacle::Segment> segments;
  std::vector<Bounds> bounds;
};

Nearest nearest_to(const Curve& way, const Obstacles& obstacles) {
  const Bounds box(way.box());
  Nearest nearest;
  for (std::size_t i = 0; i < obstacles.segments.size(); ++i) {
    if (double(nearest.distance) <= obstacles.bounds[i].apart(box)) continue;
    const Vec p(obstacles.segments[i].a), q(obstacles.segments[i].b);
    const Nearest found = way.arc ? arc_to_segment(way, p, q) : segment_to_segment(way, p, q);
    nearest.offer(found.distance, found.centre);
  }
  return nearest;
}

/// The same for all pieces, least first found.
struct Least : Nearest {
  Tally keeps_away, outside;
  void add(const Least& other) {
    offer(other.distance, other.centre);
    keeps_away.add(other.keeps_away), outside.add(other.outside);
  }
};

}  // namespace

Result<RouteReport> check_route(const input::RouteRecord& route, const std::vector<InputPart>& parts,
                                const RouteCheckOptions& options, const Context& context) {
  if (!(std::isfinite(options.radius) && options.radius > 0))
    return Error{ErrorCode::usage, "the radius must be a finite positive number", "", ""};
  const Obstacle obstacle(parts);
  if (obstacle.segments().items().empty()) return Error{ErrorCode::input, "the input holds no line or point", "", ""};
  Obstacles all{obstacle.segments().items(), {}};
  for (const auto& segment : all.segments) all.bounds.emplace_back(segment.box());

  std::vector<Curve> ways;
  Box box = obstacle.box();
  RouteReport report;
  for (const input::ResultPiece& piece : route.pieces) {
    ways.push_back(curve_of(piece));
    box.add(ways.back().box());
    report.length += double(ways.back().length());
  }
  report.radius = options.radius, report.pieces = ways.size(), report.obstacles = all.segments.size();
  report.scale = double(std::max({Real(options.radius), (box.x1 - box.x0) / 2, (box.y1 - box.y0) / 2}));
  report.tolerance = double(std::max(Real(1e-9L) * report.scale, 64 * obstacle.resolution()));
  const Real limit = Real(report.tolerance) + options.max_error;

  Tally joined;
  for (std::size_t i = 1; i < ways.size(); ++i)
    joined.add(distance(ways[i - 1].b, ways[i].a), report.tolerance, ways[i].a);
  const Least least = tally_all<Least>(context, ways.size(), [&](std::size_t i, Least& sum) {
    if (context.cancelled()) return;
    const Nearest nearest = nearest_to(ways[i], all);
    sum.offer(nearest.distance, nearest.centre);
    sum.keeps_away.add(options.radius - nearest.distance, limit, nearest.centre);
    // A piece that keeps away from all outlines is inside of a polygon as a whole or not at all.
    sum.outside.add(obstacle.in_polygon(ways[i].a) ? options.radius : 0, limit, ways[i].a);
  });
  if (context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  report.clearance = double(least.distance);
  report.nearest = {double(least.centre.x), double(least.centre.y)};
  report.checks.push_back(joined.check("pieces follow one another", report.tolerance));
  report.checks.push_back(least.keeps_away.check("the disk keeps away", limit));
  if (obstacle.has_polygons()) report.checks.push_back(least.outside.check("outside of polygons", limit));
  if (route.clearance) {
    Tally told;
    const Real allowed = limit + parabola_error * Real(options.radius);
    told.add(*route.clearance - least.distance, allowed, least.centre);
    report.checks.push_back(told.check("clearance as told", allowed));
  }
  return report;
}

}  // namespace krepl::verify
