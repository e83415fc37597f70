// What the interface promises beyond geometry: provenance, senses, errors, cancelling.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/zone_case.hpp"

namespace krepl::test {
namespace {

double off_line(Point p, Point a, Point b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  return std::abs(dx * (p.y - a.y) - dy * (p.x - a.x)) / std::hypot(dx, dy);
}

const ZoneCase tangle{{line({{0, 0}, {9, 2}, {3, 7}, {8, -4}, {1, 5}}), line({{-3, 1}, {12, 1}}), point(14, 6),
                       point(5, 12), ring({{20, 0}, {26, 0}, {23, 5}}), ring({{22, 1}, {24, 1}, {23, 2}})},
                      0.75};

TEST(Interface, EachPieceNamesItsCause) {
  const auto made = zone_of(tangle);
  ASSERT_TRUE(made.ok()) << made.error().text();
  const Zone& zone = *made;
  const Network& network = zone.network();
  const Point o = network.origin();
  const auto absolute = [&](std::uint32_t v) {
    return Point{network.vertices()[v].x + o.x, network.vertices()[v].y + o.y};
  };
  std::size_t arcs = 0;
  for (std::uint32_t e = 0; e < zone.piece_count(); ++e) {
    const Zone::Piece piece = zone.piece(e);
    if (piece.kind == Zone::Kind::arc) {
      ++arcs;
      ASSERT_LT(piece.source, network.vertices().size());
      EXPECT_EQ(piece.center, absolute(piece.source));
      EXPECT_NEAR(std::hypot(piece.start.x - piece.center.x, piece.start.y - piece.center.y), zone.radius(),
                  1e-12 * zone.scale());
      EXPECT_NEAR(std::hypot(piece.end.x - piece.center.x, piece.end.y - piece.center.y), zone.radius(),
                  1e-12 * zone.scale());
    } else {
      ASSERT_LT(piece.source, network.segments().size());
      const auto s = network.segments()[piece.source];
      const Point from = absolute(piece.reversed ? s.b : s.a), to = absolute(piece.reversed ? s.a : s.b);
      for (const Point p : {piece.start, piece.end})
        EXPECT_NEAR(off_line(p, from, to), zone.radius(), 1e-12 * zone.scale());
      // Along the source, with the source on the left.
      const double dx = to.x - from.x, dy = to.y - from.y;
      EXPECT_GT((piece.end.x - piece.start.x) * dx + (piece.end.y - piece.start.y) * dy, 0);
      EXPECT_LT(dx * (piece.start.y - from.y) - dy * (piece.start.x - from.x), 0);
    }
  }
  EXPECT_GT(arcs, 0u);
  EXPECT_LT(arcs, zone.piece_count());
}

TEST(Interface, RingsAndPolygonsPartitionThePieces) {
  const auto made = zone_of(tangle);
  ASSERT_TRUE(made.ok()) << made.error().text();
  const Zone& zone = *made;
  EXPECT_EQ(zone.ring_begin(0), 0u);
  EXPECT_EQ(zone.ring_begin(std::uint32_t(zone.ring_count())), zone.piece_count());
  std::vector<int> owner(zone.ring_count(), 0);
  for (std::uint32_t p = 0; p < zone.polygon_count(); ++p) {
    const auto polygon = zone.polygon(p);
    EXPECT_FALSE(zone.ring_is_hole(polygon.outer));
    ++owner[polygon.outer];
    for (const auto h : polygon.holes) {
      EXPECT_TRUE(zone.ring_is_hole(h));
      ++owner[h];
    }
  }
  for (const int n : owner) EXPECT_EQ(n, 1);
  EXPECT_EQ(zone.polygon_count() + zone.hole_count(), zone.ring_count());
  const Subdivision& s = zone.subdivision();
  EXPECT_EQ(s.edge_count(), zone.piece_count());
  for (std::uint32_t r = 0; r < zone.ring_count(); ++r)
    for (std::uint32_t e = zone.ring_begin(r); e < zone.ring_begin(r + 1); ++e) {
      const std::uint32_t following = e + 1 < zone.ring_begin(r + 1) ? e + 1 : zone.ring_begin(r);
      EXPECT_EQ(s.next[2 * e], 2 * following);
      EXPECT_EQ(s.origin[2 * e], e);
      EXPECT_EQ(zone.piece(e).end, zone.piece(following).start);
    }
}

TEST(Interface, BadRadiusIsAUsageError) {
  for (const double r :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const auto zone = zone_of({{line({{0, 0}, {1, 1}})}, r});
    ASSERT_FALSE(zone.ok()) << r;
    EXPECT_EQ(zone.error().code, ErrorCode::usage) << r;
    EXPECT_FALSE(zone.error().what.empty());
  }
}

TEST(Interface, RadiusBelowTheCoordinatesResolutionIsAnError) {
  const auto zone = zone_of({{line({{1e15, 1e15}, {1e15 + 10, 1e15 + 7}})}, 1e-3});
  EXPECT_FALSE(zone.ok());
}

TEST(Interface, BadCoordinatesAreNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const Point bad : {Point{nan, 0}, Point{0, nan}, Point{inf, 0}, Point{0, -inf}}) {
    Network::Builder builder;
    builder.add_line(std::vector<Point>{{0, 0}, {1, 1}}, 7);
    builder.add_line(std::vector<Point>{{0, 0}, bad, {2, 2}}, 8);
    const auto network = std::move(builder).build();
    ASSERT_FALSE(network.ok());
    EXPECT_EQ(network.error().code, ErrorCode::input);
    EXPECT_NE(network.error().where.find('8'), std::string::npos) << network.error().text();
  }
  EXPECT_FALSE(Network::Builder().build().ok());
}

TEST(Interface, CancellingEndsWithCancelled) {
  ZoneCase c{{}, 3};
  for (int k = 0; k < 2000; ++k) c.parts.push_back(line({{double(k), 0}, {double(2000 - k), 100}}));
  auto network = network_of(c);
  ASSERT_TRUE(network.ok());
  const std::atomic<bool> stop{true};
  Context context;
  context.cancel = &stop;
  const auto zone =
      compute_zone(std::make_shared<const Network>(std::move(network).value()), ZoneOptions{c.radius}, context);
  ASSERT_FALSE(zone.ok());
  EXPECT_EQ(zone.error().code, ErrorCode::cancelled);
}

TEST(Interface, ProgressRisesToOne) {
  ZoneCase c{{}, 0.3};
  for (int k = 0; k < 300; ++k)
    c.parts.push_back(line({{double(k % 17), double(k % 19)}, {double(k % 23), double(k % 29)}}));
  std::vector<double> seen;
  Context context;
  context.progress = [&](double f) { seen.push_back(f); };
  auto network = network_of(c);
  ASSERT_TRUE(network.ok());
  ASSERT_TRUE(
      compute_zone(std::make_shared<const Network>(std::move(network).value()), ZoneOptions{c.radius}, context).ok());
  for (const double f : seen) EXPECT_TRUE(f >= 0 && f <= 1) << f;
}

}  // namespace
}  // namespace krepl::test
