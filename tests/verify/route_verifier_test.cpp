// The verifier of routes itself: least clearances against dense samples, planted faults, and routes of the engines.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "krepl/route.hpp"
#include "support/environment.hpp"
#include "support/zone_case.hpp"
#include "verify/route_verifier.hpp"

namespace krepl::test {
namespace {

using input::ResultPiece;
using input::RouteRecord;
using verify::Check;
using verify::RouteReport;

ResultPiece straight(Point a, Point b) { return {false, a, {}, b}; }
ResultPiece arc(Point c, double r, double from, double to) {
  const auto at = [&](double t) { return Point{c.x + r * std::cos(t), c.y + r * std::sin(t)}; };
  return {true, at(from), at((from + to) / 2), at(to)};
}
RouteRecord route_of(std::vector<ResultPiece> pieces) {
  RouteRecord route;
  route.pieces = std::move(pieces);
  return route;
}
RouteReport check(const RouteRecord& route, const ZoneCase& c) {
  verify::RouteCheckOptions options;
  options.radius = c.radius;
  auto report = verify::check_route(route, c.parts, options);
  EXPECT_TRUE(report) << report.error().text();
  return report ? *report : RouteReport{};
}
bool passes(const RouteReport& report, const std::string& name) {
  for (const Check& c : report.checks)
    if (c.name == name) return c.ok();
  ADD_FAILURE() << "no check " << name;
  return false;
}

long double to_segment(long double x, long double y, Point a, Point b) {
  const long double dx = (long double)b.x - a.x, dy = (long double)b.y - a.y, px = x - a.x, py = y - a.y, whole = dx * dx + dy * dy;
  const long double t = whole > 0 ? std::clamp((px * dx + py * dy) / whole, 0.0L, 1.0L) : 0.0L;
  return std::hypot(px - t * dx, py - t * dy);
}

TEST(RouteVerifier, LeastDistanceOfSegmentsAndArcsIsThatOfDenseSamples) {
  std::mt19937_64 random(seed());
  std::uniform_real_distribution<double> at(-4, 4), size(0.2, 3), angle(0, 2 * std::numbers::pi);
  for (int n = 0; n < int(300 * effort()) + 30; ++n) {
    const auto place = [&] {
      const double x = at(random);
      return Point{x, at(random)};
    };
    const Point a = place(), b = n % 7 == 0 ? a : place();
    const ZoneCase c{{a.x == b.x && a.y == b.y ? point(a.x, a.y) : line({a, b})}, 0.01};
    const bool bent = n % 3 != 0;
    const Point from = place(), to = place();
    const double r = size(random), begin = angle(random), turn = (n % 2 ? 1 : -1) * (0.05 + angle(random) * 0.98);
    const RouteReport report = check(route_of({bent ? arc(from, r, begin, begin + turn) : straight(from, to)}), c);
    long double least = 1e300L;
    constexpr int steps = 4000;
    for (int k = 0; k <= steps; ++k) {
      const double t = double(k) / steps, w = begin + t * turn;
      const Point p = bent ? Point{from.x + r * std::cos(w), from.y + r * std::sin(w)}
                           : Point{from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)};
      least = std::min(least, to_segment(p.x, p.y, a, b));
    }
    const double step = bent ? r * std::abs(turn) / steps : std::hypot(to.x - from.x, to.y - from.y) / steps;
    EXPECT_LE(report.clearance, double(least) + 1e-12) << n;
    EXPECT_GE(report.clearance, double(least) - step) << n;
    EXPECT_NEAR(double(to_segment(report.nearest.x, report.nearest.y, a, b)), report.clearance, 1e-9) << n;
  }
}

const ZoneCase wall{{line({{0, 0}, {0, 10}})}, 1};

TEST(RouteVerifier, PlantedFaults) {
  const double pi = std::numbers::pi;
  const RouteRecord around = route_of({straight({-5, 10}, {-1, 10}), arc({0, 10}, 1, pi, 0), straight({1, 10}, {1, 2})});
  EXPECT_TRUE(check(around, wall).ok());
  EXPECT_NEAR(check(around, wall).clearance, 1, 1e-15);
  EXPECT_NEAR(check(around, wall).length, 4 + pi + 8, 1e-12);
  EXPECT_FALSE(check(around, {wall.parts, 1 + 1e-6}).ok());
  const RouteRecord through = route_of({straight({-5, 5}, {5, 5})});
  EXPECT_FALSE(passes(check(through, wall), "the disk keeps away"));
  EXPECT_EQ(check(through, wall).clearance, 0);
  RouteRecord torn = around;
  torn.pieces[2].start.x += 1e-6;
  EXPECT_FALSE(passes(check(torn, wall), "pieces follow one another"));
  RouteRecord cut = around;  // the arc the other way round goes through the wall
  cut.pieces[1] = arc({0, 10}, 1, pi, 2 * pi);
  EXPECT_FALSE(passes(check(cut, wall), "the disk keeps away"));
  RouteRecord boasting = around;
  boasting.clearance = 1.1;
  EXPECT_FALSE(passes(check(boasting, wall), "clearance as told"));
  boasting.clearance = 1;
  EXPECT_TRUE(check(boasting, wall).ok());
  const ZoneCase block{{ring({{0, 0}, {40, 0}, {40, 40}, {0, 40}})}, 1};
  EXPECT_FALSE(passes(check(route_of({straight({18, 20}, {22, 20})}), block), "outside of polygons"));
}

TEST(RouteVerifier, RoutesOfTheEngineAreSound) {
  std::mt19937_64 random(seed() + 1);
  std::uniform_real_distribution<double> at(0, 30);
  int found = 0;
  for (int n = 0; n < int(40 * effort()) + 6; ++n) {
    ZoneCase c;
    c.radius = 0.8;
    for (int k = 0; k < 25; ++k) {
      const double x = at(random), y = at(random);
      c.parts.push_back(k % 2 ? point(x, y) : line({{x, y}, {x + 3, y + at(random) / 10}}));
    }
    RouteOptions options;
    options.radius = c.radius, options.from = {-3, -3}, options.to = {36, 34};
    const auto route = compute_route(std::make_shared<const Network>(*network_of(c)), options);
    if (!route) continue;
    ++found;
    RouteRecord record;
    record.clearance = route->clearance;
    for (const Route::Piece& p : route->pieces) {
      if (p.kind == Route::Kind::line) {
        record.pieces.push_back(straight(p.start, p.end));
        continue;
      }
      const double from = std::atan2(p.start.y - p.center.y, p.start.x - p.center.x);
      double span = std::atan2(p.end.y - p.center.y, p.end.x - p.center.x) - from;
      if (p.clockwise && span > 0) span -= 2 * std::numbers::pi;
      if (!p.clockwise && span < 0) span += 2 * std::numbers::pi;
      ResultPiece piece = arc(p.center, route->turn_radius, from, from + span);
      piece.start = p.start, piece.end = p.end;
      record.pieces.push_back(piece);
    }
    const RouteReport report = check(record, c);
    EXPECT_TRUE(report.ok()) << c;
    EXPECT_NEAR(report.clearance, route->clearance, 1e-9) << c;
    EXPECT_NEAR(report.length, route->length, 1e-9) << c;
    EXPECT_FALSE(check(record, {c.parts, route->clearance + 1e-5}).ok()) << c;
  }
  EXPECT_GT(found, 3);
}

/// A ridge of height 2 along x = 0, over a plane.
Terrain ridge() {
  std::vector<Point3> vertices;
  for (double x : {-10.0, -2.0, 0.0, 2.0, 10.0})
    for (double y : {-10.0, 10.0}) vertices.push_back({x, y, x == 0 ? 2.0 : 0.0});
  std::vector<std::array<Terrain::Index, 3>> triangles;
  for (Terrain::Index a = 0; a < 8; a += 2) {
    triangles.push_back({a, a + 2, a + 3});
    triangles.push_back({a, a + 3, a + 1});
  }
  return *Terrain::from_triangles(std::move(vertices), std::move(triangles));
}

RouteReport fly(std::vector<Point3> points, double radius, verify::RouteCheckOptions options = {}) {
  RouteRecord record;
  record.points = std::move(points);
  for (std::size_t i = 1; i < record.points.size(); ++i)
    record.pieces.push_back(straight({record.points[i - 1].x, record.points[i - 1].y}, {record.points[i].x, record.points[i].y}));
  options.radius = radius;
  auto report = verify::check_flight(record, ridge(), options);
  EXPECT_TRUE(report) << report.error().text();
  return report ? *report : RouteReport{};
}

TEST(FlightVerifier, LeastClearanceOverARidge) {
  // Level at height 3 the ridge's top is 1 below.
  const RouteReport level = fly({{-8, 0, 3}, {8, 0, 3}}, 1);
  EXPECT_TRUE(level.ok());
  EXPECT_NEAR(level.clearance, 1, 1e-12);
  EXPECT_NEAR(level.nearest.x, 0, 1e-3);
  EXPECT_LT(level.unproven, 1e-4) << "only where it touches";
  const RouteReport higher = fly({{-8, 0, 3.2}, {8, 0, 3.2}}, 1);
  EXPECT_EQ(higher.unproven, 0);
  EXPECT_NEAR(higher.clearance, 1.2, 1e-3);
  EXPECT_FALSE(fly({{-8, 0, 3 - 1e-6}, {8, 0, 3 - 1e-6}}, 1).ok());
  EXPECT_FALSE(fly({{-8, 0, 1}, {8, 0, 1}}, 0.5).ok()) << "through the ridge, free at both ends";
}

TEST(FlightVerifier, LimitsAndTakeOff) {
  verify::RouteCheckOptions options;
  options.ceiling = 4, options.max_slope = 0.25;
  const RouteReport fine = fly({{-8, 0, 1}, {-8, 0, 2.5}, {0, 0, 4}, {8, 0, 2}, {8, 0, 1}}, 1, options);
  EXPECT_TRUE(fine.ok());
  EXPECT_NEAR(fine.steepest, 0.25, 1e-15);
  EXPECT_NEAR(fine.climb, 3, 1e-15);
  EXPECT_FALSE(passes(fly({{-8, 0, 2.5}, {0, 0, 4.0001}, {8, 0, 2.5}}, 1, options), "below the ceiling"));
  EXPECT_FALSE(passes(fly({{-8, 0, 2.5}, {-1, 0, 4}, {8, 0, 3.9}}, 0.5, {.max_slope = 0.2}), "no steeper than allowed"));
  // Straight up in the middle is no take-off.
  EXPECT_FALSE(passes(fly({{-8, 0, 3}, {-5, 0, 3}, {-5, 0, 4}, {8, 0, 4}}, 1, options), "no steeper than allowed"));
}

TEST(FlightVerifier, RandomLinesAgainstDenseSamples) {
  std::mt19937_64 random(seed() + 2);
  std::uniform_real_distribution<double> xy(-9, 9), z(-1, 5);
  for (int n = 0; n < int(60 * effort()) + 10; ++n) {
    const auto place = [&] {
      const double x = xy(random), y = xy(random);
      return Point3{x, y, z(random)};
    };
    const Point3 a = place(), b = place();
    const RouteReport report = fly({a, b}, 0.7);
    // The distance from the two planes and the two slopes of the ridge; inside of it, 0.
    double least = 1e300;
    constexpr int steps = 2000;
    for (int k = 0; k <= steps; ++k) {
      const double t = double(k) / steps;
      const double x = std::abs(a.x + t * (b.x - a.x)), height = a.z + t * (b.z - a.z);
      const double top = x < 2 ? 2 - x : 0;
      double d = 0;
      if (height > top) {
        const auto to = [&](double x0, double z0, double x1, double z1) {
          return double(to_segment(x, height, {x0, z0}, {x1, z1}));
        };
        d = std::min({to(0, 2, 2, 0), to(2, 0, 10, 0), to(-2, 0, 0, 2)});
      }
      least = std::min(least, d);
    }
    EXPECT_EQ(report.ok(), least >= 0.7 - 1e-6) << n << " " << least;
    if (report.ok()) {
      EXPECT_NEAR(report.clearance, least, 1e-3 + 0.02) << n;
    }
  }
}

}  // namespace
}  // namespace krepl::test
