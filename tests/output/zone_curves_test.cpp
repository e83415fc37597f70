// Points on arcs against quadruple precision, and chords against the deviation asked for.
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "output/linear.hpp"
#include "output/zone_curves.hpp"
#include "support/environment.hpp"

namespace krepl::test {
namespace {

using std::numbers::pi;
using Kind = Zone::Kind;

Point on_circle(Point c, double r, double angle) { return {c.x + r * std::cos(angle), c.y + r * std::sin(angle)}; }

Zone::Piece arc(Point center, double r, double from, double span) {
  return {Kind::arc, on_circle(center, r, from), on_circle(center, r, from + span), center, 0, false, r};
}

double distance(Point a, Point b) {
  return static_cast<double>(std::hypot(static_cast<long double>(a.x) - b.x, static_cast<long double>(a.y) - b.y));
}

TEST(ZoneCurves, MiddleIsOnTheCircleHalfway) {
  std::mt19937_64 random(seed());
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 20000; ++i) {
    double r = std::pow(10, 6 * unit(random) - 3), from = 2 * pi * unit(random);
    double span = i % 2 == 0 ? 2 * pi * unit(random) : std::pow(10, -6 * unit(random));
    Point center{1e6 * (unit(random) - 0.5), 1e6 * (unit(random) - 0.5)};
    Zone::Piece piece = arc(center, r, from, span);
    if (span > 2 * pi - 1e-3 || output::is_negligible(piece)) continue;
    double rounding = 4e-16 * (r + std::fabs(center.x) + std::fabs(center.y));
    Point middle = output::arc_middle(center, piece.start, piece.end);
    EXPECT_NEAR(distance(middle, center), r, 2 * rounding);
    EXPECT_NEAR(distance(middle, piece.start), distance(middle, piece.end), 4 * rounding);
    EXPECT_NEAR(distance(middle, on_circle(center, r, from + span / 2)), 0, 1e-15 * r / std::sin(span / 2) + 8 * rounding);
  }
}

TEST(ZoneCurves, ShortArcsKeepTheirBulge) {
  // Ends a few units in the last place outside of the nominal circle, an arc flatter than that distance.
  Point center{4e6, 4e6};
  for (double span : {1e-2, 1e-4, 1e-5}) {
    Zone::Piece piece = arc(center, 250 + 1.5e-8, 1, span);
    Point middle = output::arc_middle(center, piece.start, piece.end);
    Point chord{piece.end.x - piece.start.x, piece.end.y - piece.start.y};
    double bulge = (chord.x * (piece.start.y - middle.y) - chord.y * (piece.start.x - middle.x)) / std::hypot(chord.x, chord.y);
    EXPECT_NEAR(bulge, 500 * std::pow(std::sin(span / 4), 2), 1.5e-9);
  }
}

TEST(ZoneCurves, ArcsBeyondHalfATurnAreCut) {
  EXPECT_EQ(output::arc_points(arc({0, 0}, 1, 0.1, 3.1)).size(), 3u);
  EXPECT_EQ(output::arc_points(arc({0, 0}, 1, 0.1, 3.2)).size(), 5u);
  EXPECT_EQ(output::arc_points(arc({0, 0}, 1, 0.1, 6.2)).size(), 5u);
}

TEST(ZoneCurves, FullCircle) {
  Zone::Piece circle{Kind::arc, {5, 3}, {5, 3}, {3, 3}, 0, false, 2};
  EXPECT_EQ(output::arc_angle(circle), 2 * pi);
  EXPECT_EQ(output::piece_length(circle), 4 * pi);
  EXPECT_EQ(output::arc_points(circle), (std::vector<Point>{{5, 3}, {3, 5}, {1, 3}, {3, 1}, {5, 3}}));
  EXPECT_EQ(output::arc_ends(circle, pi).size(), 5u);
  EXPECT_EQ(output::arc_ends(circle, 1).size(), 9u);
}

TEST(ZoneCurves, ArcsOfAFewUnitsInTheLastPlaceAreStraight) {
  Point start{1e6, 1e6};
  Zone::Piece tiny{Kind::arc, start, {1e6, std::nextafter(1e6, 2e6)}, {1e6 - 5, 1e6}, 0, false, 5};
  EXPECT_TRUE(output::is_negligible(tiny));
  EXPECT_LT(output::piece_length(tiny), 1e-9);
  EXPECT_FALSE(output::is_negligible(arc({1e6, 1e6}, 5, 0, 1e-6)));
}

Zone zone_of(std::initializer_list<std::vector<Point>> lines, double radius) {
  Network::Builder builder;
  for (const std::vector<Point>& line : lines) builder.add_line(line);
  Result<Network> network = std::move(builder).build();
  EXPECT_TRUE(network.ok());
  Result<Zone> zone = compute_zone(std::make_shared<const Network>(std::move(*network)), {radius});
  EXPECT_TRUE(zone.ok()) << zone.error().text();
  return std::move(*zone);
}

TEST(ZoneCurves, RunsAlternateAndJoin) {
  Zone zone = zone_of({{{0, 0}, {10, 0}, {10, 10}, {3, 8}}, {{0, 20}, {1, 20}}, {{40, 40}}}, 1.5);
  for (std::uint32_t ring = 0; ring < zone.ring_count(); ++ring) {
    std::vector<output::CurveRun> runs = output::ring_runs(zone, ring);
    EXPECT_EQ(runs.front().points.front(), runs.back().points.back());
    for (std::size_t i = 0; i < runs.size(); ++i) {
      EXPECT_GE(runs[i].points.size(), runs[i].arc ? 3u : 2u);
      if (runs[i].arc) {
        EXPECT_EQ(runs[i].points.size() % 2, 1u);
      }
      if (i == 0) continue;
      EXPECT_NE(runs[i].arc, runs[i - 1].arc);
      EXPECT_EQ(runs[i].points.front(), runs[i - 1].points.back());
    }
  }
}

TEST(ZoneCurves, RingsMeasureUpToTheZone) {
  Zone zone = zone_of({{{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}}, {{5, -3}, {5, 30}}, {{40, 40}}}, 1.5);
  double area = 0, length = 0;
  for (std::uint32_t ring = 0; ring < zone.ring_count(); ++ring) {
    output::RingMeasure measure = output::measure_ring(zone, ring);
    EXPECT_EQ(measure.area < 0, zone.ring_is_hole(ring));
    area += measure.area;
    length += measure.length;
  }
  EXPECT_NEAR(area, zone.area(), 1e-11);
  EXPECT_NEAR(length, zone.perimeter(), 1e-11);
}

TEST(Linearizer, KeepsTheDeviationAskedForAndUsesIt) {
  Zone zone = zone_of({{{0, 0}, {10, 0}, {10, 10}}, {{40, 40}}}, 2);
  for (double max_error : {1.0, 0.1, 1e-3, 1e-7}) {
    output::Linearizer linearizer(2, max_error);
    double worst = 0;
    for (std::uint32_t ring = 0; ring < zone.ring_count(); ++ring) {
      std::vector<Point> points = linearizer.ring(zone, ring);
      EXPECT_EQ(points.front(), points.back());
      EXPECT_GE(points.size(), 4u);
      for (std::size_t i = 1; i < points.size(); ++i) {
        // Between two vertices at distance 2 from the corner or point they go around, the chord's middle is nearest to it.
        Point middle{(points[i - 1].x + points[i].x) / 2, (points[i - 1].y + points[i].y) / 2};
        for (Point c : {Point{0, 0}, Point{10, 0}, Point{10, 10}, Point{40, 40}}) {
          bool around = std::fabs(distance(points[i], c) - 2) < 1e-9 && std::fabs(distance(points[i - 1], c) - 2) < 1e-9;
          if (around) worst = std::max(worst, 2 - distance(middle, c));
        }
      }
    }
    EXPECT_LE(worst, max_error * (1 + 1e-8) + 1e-14);
    EXPECT_NEAR(worst, linearizer.deviation(), 1e-9 * worst + 1e-14);
    EXPECT_GT(linearizer.deviation(), max_error / 4);
  }
}

}  // namespace
}  // namespace krepl::test
