// Parallel curves: known ones, and random ones by distances, sides, lengths, and GEOS for polygons.
#include "krepl/offset.hpp"

#include <geos_c.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "krepl/zone.hpp"
#include "support/environment.hpp"

namespace krepl::test {
namespace {

constexpr double pi = std::numbers::pi;
using Line = std::vector<Point>;

Network network_of(const std::vector<Line>& lines, bool rings = false) {
  Network::Builder builder;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (rings)
      builder.add_ring(lines[i], 0);
    else
      builder.add_line(lines[i], std::int64_t(i));
  }
  return std::move(*std::move(builder).build());
}

std::vector<OffsetCurve> curves(const std::vector<Line>& lines, double distance, bool rings = false) {
  auto result = offset_curves(network_of(lines, rings), distance);
  EXPECT_TRUE(result.ok()) << (result ? "" : result.error().text());
  return std::move(*result);
}

double total(const std::vector<OffsetCurve>& all) {
  double sum = 0;
  for (const OffsetCurve& curve : all) sum += curve.length;
  return sum;
}

/// Points along a piece, ends included.
Line samples(const OffsetCurve::Piece& p, int count) {
  Line result;
  const double from = std::atan2(p.start.y - p.center.y, p.start.x - p.center.x);
  double to = std::atan2(p.end.y - p.center.y, p.end.x - p.center.x);
  if (p.arc && !p.clockwise && to < from) to += 2 * pi;
  if (p.arc && p.clockwise && to > from) to -= 2 * pi;
  const double radius = std::hypot(p.start.x - p.center.x, p.start.y - p.center.y);
  for (int i = 0; i <= count; ++i) {
    const double t = double(i) / count, angle = from + t * (to - from);
    if (p.arc)
      result.push_back({p.center.x + radius * std::cos(angle), p.center.y + radius * std::sin(angle)});
    else
      result.push_back({p.start.x + t * (p.end.x - p.start.x), p.start.y + t * (p.end.y - p.start.y)});
  }
  return result;
}

/// Distance of p from the line, and on which sides p is of those segments that are as near: 1 left, 2 right.
struct Nearest {
  double distance = INFINITY;
  unsigned sides = 0;
};
Nearest nearest(const Line& line, Point p) {
  Nearest best;
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t i = 1; i < line.size(); ++i) {
      const Point a = line[i - 1], b = line[i];
      const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
      const double t = square == 0 ? 0 : std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / square, 0.0, 1.0);
      const double d = std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
      if (pass == 0)
        best.distance = std::min(best.distance, d);
      else if (d <= best.distance * (1 + 1e-9))
        best.sides |= dx * (p.y - a.y) - dy * (p.x - a.x) > 0 ? 1 : 2;
    }
  }
  return best;
}

Line random_line(std::mt19937_64& random, std::size_t count) {
  Line line;
  for (std::size_t i = 0; i < count; ++i)
    line.push_back({double(random() % 10000) / 100, double(random() % 10000) / 100});
  return line;
}

void check_course(const OffsetCurve& curve, double radius) {
  double length = 0;
  for (std::size_t i = 0; i < curve.pieces.size(); ++i) {
    const OffsetCurve::Piece& p = curve.pieces[i];
    EXPECT_TRUE(i == 0 || curve.pieces[i - 1].end == p.start);
    const Line points = samples(p, 50);
    for (std::size_t k = 1; k < points.size(); ++k)
      length += std::hypot(points[k].x - points[k - 1].x, points[k].y - points[k - 1].y);
  }
  EXPECT_NEAR(length, curve.length, 1e-3 * curve.length + 1e-6 * radius);
  EXPECT_EQ(curve.closed, curve.pieces.front().start == curve.pieces.back().end);
}

// --- known curves ----------------------------------------------------------------------------------------------------

const Line corner = {{0, 0}, {10, 0}, {10, 10}};

TEST(Offset, InnerSideOfACorner) {
  const auto all = curves({corner}, 1);
  ASSERT_EQ(all.size(), 1u);
  ASSERT_EQ(all[0].pieces.size(), 2u);
  EXPECT_NEAR(all[0].length, 18, 1e-12);
  EXPECT_NEAR(all[0].pieces[0].start.x, 0, 1e-12);
  EXPECT_NEAR(all[0].pieces[0].start.y, 1, 1e-12);
  EXPECT_NEAR(all[0].pieces[1].start.x, 9, 1e-12);
  EXPECT_NEAR(all[0].pieces[1].end.y, 10, 1e-12);
  EXPECT_FALSE(all[0].closed);
}

TEST(Offset, OuterSideOfACorner) {
  const auto all = curves({corner}, -1);
  ASSERT_EQ(all.size(), 1u);
  ASSERT_EQ(all[0].pieces.size(), 3u);
  EXPECT_NEAR(all[0].length, 20 + pi / 2, 1e-12);
  EXPECT_TRUE(all[0].pieces[1].arc);
  EXPECT_FALSE(all[0].pieces[1].clockwise);
  EXPECT_NEAR(all[0].pieces[0].start.y, -1, 1e-12);
  EXPECT_NEAR(all[0].pieces[2].end.x, 11, 1e-12);
  // From the other end it is the left side, and its arc runs the other way.
  const auto back = curves({{corner.rbegin(), corner.rend()}}, 1);
  ASSERT_EQ(back[0].pieces.size(), 3u);
  EXPECT_TRUE(back[0].pieces[1].clockwise);
  EXPECT_EQ(back[0].pieces[0].start, all[0].pieces[2].end);
}

TEST(Offset, CurvesFallApartAndVanish) {
  // Into a bottle whose neck is 1 wide: at 1 only the belly has room.
  const Line bottle = {{4.5, 20}, {4.5, 10}, {0, 10}, {0, 0}, {10, 0}, {10, 10}, {5.5, 10}, {5.5, 20}};
  const auto left = curves({bottle}, 1);
  ASSERT_EQ(left.size(), 1u);
  EXPECT_TRUE(left[0].closed);
  EXPECT_EQ(curves({bottle}, 5.5).size(), 0u);
  EXPECT_EQ(curves({bottle}, -1).size(), 1u);
}

TEST(Offset, ClosedLineAndSpike) {
  const Line square = {{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}};
  const auto inner = curves({square}, 1), outer = curves({square}, -1);
  ASSERT_EQ(inner.size(), 1u);
  ASSERT_EQ(outer.size(), 1u);
  EXPECT_TRUE(inner[0].closed && outer[0].closed);
  EXPECT_NEAR(inner[0].length, 32, 1e-12);
  EXPECT_NEAR(outer[0].length, 40 + 2 * pi, 1e-12);
  // There and back: both sides are left, joined round the tip; nothing where the line starts and ends.
  const auto spike = curves({{{0, 0}, {10, 0}, {0, 0}}}, 1);
  EXPECT_NEAR(total(spike), 20 + 2 * pi, 1e-12);
}

TEST(Offset, PolygonsGrowAndShrink) {
  const Line square = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  EXPECT_NEAR(total(curves({square}, 1, true)), 40 + 2 * pi, 1e-12);
  EXPECT_NEAR(total(curves({square}, -1, true)), 32, 1e-12);
  EXPECT_NEAR(total(curves({{square.rbegin(), square.rend()}}, -1, true)), 32, 1e-12);
  EXPECT_EQ(curves({square}, -5.01, true).size(), 0u);
  // With a hole, whose curve inwards (of the polygon) has round corners.
  const Line hole = {{4, 4}, {6, 4}, {6, 6}, {4, 6}};
  EXPECT_NEAR(total(curves({square, hole}, -1, true)), 32 + 8 + 2 * pi, 1e-12);
  EXPECT_NEAR(total(curves({square, hole}, 0.5, true)), 40 + pi + 4, 1e-12);
  // A dumb-bell whose bar is 1 wide falls in two.
  const Line bell = {{0, 0},   {10, 0},  {10, 4.5}, {20, 4.5}, {20, 0},  {30, 0},
                     {30, 10}, {20, 10}, {20, 5.5}, {10, 5.5}, {10, 10}, {0, 10}};
  EXPECT_EQ(curves({bell}, -1, true).size(), 2u);
  EXPECT_EQ(curves({bell}, -0.25, true).size(), 1u);
}

TEST(Offset, PointsAndRefusals) {
  EXPECT_TRUE(curves({{{1, 1}}, {{2, 2}, {2, 2}}}, 1).empty());
  EXPECT_TRUE(curves({{{2, 2}, {2, 2}, {2, 2}}}, 1, true).empty());
  for (double distance : {0.0, double(NAN), double(INFINITY)}) {
    const auto refused = offset_curves(network_of({corner}), distance);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::usage);
  }
  EXPECT_FALSE(offset_curves(network_of({corner}), 1e-20).ok());
}

// --- random ones -----------------------------------------------------------------------------------------------------

TEST(Offset, OfRandomLines) {
  std::mt19937_64 random(seed());
  std::size_t arcs = 0, apart = 0;
  for (int k = 0; k < int(200 * effort()); ++k) {
    const Line line = random_line(random, 2 + random() % 8);
    const double radius = 0.3 + double(random() % 100) / 8;
    double sum = 0;
    for (double distance : {radius, -radius}) {
      const auto all = curves({line}, distance);
      apart += all.size() > 1 ? 1 : 0;
      sum += total(all);
      for (const OffsetCurve& curve : all) {
        check_course(curve, radius);
        for (const OffsetCurve::Piece& piece : curve.pieces) {
          arcs += piece.arc ? 1 : 0;
          const Line points = samples(piece, 8);
          for (Point p : points) EXPECT_NEAR(nearest(line, p).distance, radius, 1e-9 * (radius + 100));
          const unsigned middle = nearest(line, points[4]).sides;
          EXPECT_TRUE((middle & (distance > 0 ? 1u : 2u)) != 0) << middle;
        }
      }
    }
    // Both sides and the caps are the whole boundary of the zone.
    const auto zone = compute_zone(std::make_shared<const Network>(network_of({line})), {radius});
    ASSERT_TRUE(zone.ok());
    for (std::uint32_t e = 0; e < zone->piece_count(); ++e) {
      const Zone::Piece p = zone->piece(e);
      if (p.kind != Zone::Kind::arc || (p.center != line.front() && p.center != line.back())) continue;
      const OffsetCurve::Piece cap{true, false, p.start, p.end, p.center};
      const Line points = samples(cap, 2);
      const Point u{p.start.x - p.center.x, p.start.y - p.center.y},
          v{points[1].x - p.center.x, points[1].y - p.center.y};
      sum += radius * 2 * std::acos(std::clamp((u.x * v.x + u.y * v.y) / (radius * radius), -1.0, 1.0));
    }
    EXPECT_NEAR(sum, zone->perimeter(), 1e-9 * zone->perimeter());
    if (HasFailure()) return;
  }
  EXPECT_GT(double(arcs), 400 * effort());
  EXPECT_GT(double(apart), 15 * effort());
}

/// Area that curves enclose, those to the left of them.
double enclosed(const std::vector<OffsetCurve>& all) {
  double sum = 0;
  for (const OffsetCurve& curve : all) {
    for (const OffsetCurve::Piece& p : curve.pieces) {
      const Line points = samples(p, p.arc ? 512 : 1);
      for (std::size_t i = 1; i < points.size(); ++i)
        sum += (points[i - 1].x * points[i].y - points[i - 1].y * points[i].x) / 2;
    }
  }
  return sum;
}

TEST(Offset, OfRandomPolygonsAgainstGeos) {
  std::mt19937_64 random(seed() + 1);
  GEOSContextHandle_t geos = GEOS_init_r();
  std::size_t split = 0, gone = 0;
  for (int k = 0; k < int(150 * effort()); ++k) {
    Line star;
    const int count = 3 + int(random() % 12);
    for (int i = 0; i < count; ++i) {
      const double r = 2 + double(random() % 1000) / 100, angle = 2 * pi * i / count;
      star.push_back({50 + r * std::cos(angle), 50 + r * std::sin(angle)});
    }
    for (double distance : {0.7, -0.7, -1.9, -4.0, 6.0}) {
      const auto all = curves({star}, distance, true);
      GEOSCoordSequence* s = GEOSCoordSeq_create_r(geos, unsigned(count + 1), 2);
      for (int i = 0; i <= count; ++i)
        GEOSCoordSeq_setXY_r(geos, s, unsigned(i), star[std::size_t(i % count)].x, star[std::size_t(i % count)].y);
      GEOSGeometry* polygon = GEOSGeom_createPolygon_r(geos, GEOSGeom_createLinearRing_r(geos, s), nullptr, 0);
      GEOSGeometry* answer = GEOSBuffer_r(geos, polygon, distance, 256);
      double area = 0;
      GEOSArea_r(geos, answer, &area);
      const double tolerance =
          1e-3 * std::abs(distance) * (total(all) + 1);  // it simplifies by a hundredth of the distance
      EXPECT_NEAR(enclosed(all), area, tolerance + 0.01 * std::abs(distance));
      for (const OffsetCurve& curve : all) {
        EXPECT_TRUE(curve.closed);
        check_course(curve, std::abs(distance));
      }
      split += distance < 0 && all.size() > 1 ? 1 : 0;
      gone += all.empty() ? 1 : 0;
      for (GEOSGeometry* g : {answer, polygon}) GEOSGeom_destroy_r(geos, g);
    }
    if (HasFailure()) break;
  }
  GEOS_finish_r(geos);
  EXPECT_GT(split, 0u);
  EXPECT_GT(gone, 0u);
}

}  // namespace
}  // namespace krepl::test
