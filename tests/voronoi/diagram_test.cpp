// The diagram itself, by brute force: along every edge both sites are equally near and nothing is nearer. Blind spots:
// an edge that is missing (validate() and the comparison of zones see that); sites that coincide to 1e-9 S are not told
// apart.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "krepl/voronoi.hpp"
#include "support/environment.hpp"
#include "support/zone_case.hpp"
#include "support/zone_comparison.hpp"

namespace krepl::test {
namespace {

double distance(Point p, Point a, Point b) {
  const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
  const double t = square > 0 ? std::min(std::max(((p.x - a.x) * dx + (p.y - a.y) * dy) / square, 0.0), 1.0) : 0;
  return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

class Witness {
 public:
  explicit Witness(const Network& n) : n_(n), scale_(n.extent()) {}

  double nearest(Point p) const {
    const Point q = local(p);
    double least = std::numeric_limits<double>::infinity();
    for (const Point v : n_.vertices()) least = std::min(least, std::hypot(q.x - v.x, q.y - v.y));
    for (const auto s : n_.segments()) least = std::min(least, distance(q, n_.vertices()[s.a], n_.vertices()[s.b]));
    return least;
  }
  double to(const VoronoiDiagram::Site& site, Point p) const {
    const Point q = local(p);
    if (site.is_vertex) return std::hypot(q.x - n_.vertices()[site.index].x, q.y - n_.vertices()[site.index].y);
    const auto s = n_.segments()[site.index];
    return distance(q, n_.vertices()[s.a], n_.vertices()[s.b]);
  }
  double tolerance(double clearance) const { return 1e-9 * std::max(scale_, clearance); }

 private:
  Point local(Point p) const { return {p.x - n_.origin().x, p.y - n_.origin().y}; }
  const Network& n_;
  double scale_;
};

std::shared_ptr<const Network> shared(const ZoneCase& c) {
  auto network = network_of(c);
  EXPECT_TRUE(network.ok());
  return std::make_shared<const Network>(std::move(*network));
}

void expect_sound(const ZoneCase& c) {
  const auto network = shared(c);
  const auto diagram = VoronoiDiagram::build(network);
  ASSERT_TRUE(diagram.ok()) << diagram.error().text();
  EXPECT_EQ(diagram->validate().value_or("sound"), "sound");
  const Witness witness(*network);
  const double far = 2 * network->extent();
  const auto edges = diagram->edges();
  EXPECT_EQ(edges.size(), diagram->edge_count());
  for (const auto& edge : edges) {
    for (const auto& [end, clearance] : {std::pair{edge.start, edge.start_clearance}, {edge.end, edge.end_clearance}}) {
      if (clearance > far) continue;
      EXPECT_NEAR(witness.nearest(end), clearance, witness.tolerance(clearance)) << text(c);
    }
    double least = std::min(edge.start_clearance, edge.end_clearance);
    for (const Point p : diagram->points(edge, 1e-3 * network->extent(), far)) {
      const double r = witness.nearest(p);
      least = std::min(least, r);
      EXPECT_NEAR(witness.to(edge.left, p), r, witness.tolerance(r)) << text(c);
      EXPECT_NEAR(witness.to(edge.right, p), r, witness.tolerance(r)) << text(c);
    }
    EXPECT_LE(edge.minimum, least + witness.tolerance(least)) << text(c);
  }
}

TEST(VoronoiDiagram, OneSegment) {
  const ZoneCase c{{line({{0, 0}, {10, 0}})}};
  expect_sound(c);
  const auto diagram = VoronoiDiagram::build(shared(c));
  EXPECT_EQ(diagram->face_count(), 4u);  // two sides, two ends
  EXPECT_EQ(diagram->edge_count(), 4u);  // a perpendicular at each end to either side
  for (const auto& edge : diagram->edges()) EXPECT_TRUE(edge.touches_site);
}

TEST(VoronoiDiagram, OnePointHasNoEdge) {
  const auto diagram = VoronoiDiagram::build(shared({{point(3, 4)}}));
  ASSERT_TRUE(diagram.ok());
  EXPECT_EQ(diagram->face_count(), 1u);
  EXPECT_EQ(diagram->edge_count(), 0u);
  const auto zone = diagram->zone({2});
  ASSERT_TRUE(zone.ok());
  EXPECT_NEAR(zone->area(), 4 * M_PI, 1e-12);
}

TEST(VoronoiDiagram, SquareHasItsDiagonals) {
  const ZoneCase c{{line({{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}})}};
  expect_sound(c);
  const auto diagram = VoronoiDiagram::build(shared(c));
  double inside = 0;  // length of the axis inside: two diagonals
  for (const auto& edge : diagram->edges()) {
    const double length = std::hypot(edge.end.x - edge.start.x, edge.end.y - edge.start.y);
    if (!edge.touches_site && std::max(edge.start_clearance, edge.end_clearance) < 5.1) inside += length;
  }
  EXPECT_NEAR(inside, 20 * std::sqrt(2.0), 1e-12);
}

TEST(VoronoiDiagram, PointOverLineMakesAParabola) {
  const ZoneCase c{{line({{-10, 0}, {10, 0}}), point(0, 4)}};
  expect_sound(c);
  const auto diagram = VoronoiDiagram::build(shared(c));
  bool found = false;
  for (const auto& edge : diagram->edges()) {
    if (!edge.parabolic) continue;
    found = true;
    EXPECT_NEAR(edge.minimum, 2, 1e-15);
    for (const Point p : diagram->points(edge, 1e-4, 100)) EXPECT_NEAR(p.y, (p.x * p.x + 16) / 8, 1e-12);
  }
  EXPECT_TRUE(found);
}

TEST(VoronoiDiagram, CrossingSegmentsNeedNoNoding) {
  expect_sound({{line({{-5, -4}, {6, 5}}), line({{-5, 5}, {4, -3}})}});
}

TEST(VoronoiDiagram, TeeWhoseVertexLiesOnASegment) { expect_sound({{line({{0, 0}, {9, 0}}), line({{3, 0}, {3, 7}})}}); }

TEST(VoronoiDiagram, OverlapAndDuplicate) {
  expect_sound({{line({{0, 0}, {9, 0}}), line({{3, 0}, {12, 0}}), line({{9, 0}, {0, 0}}), point(4, 4)}});
}

TEST(VoronoiDiagram, StreetGridWithCocircularSites) {
  ZoneCase c;
  for (int i = 0; i < 5; ++i) {
    c.parts.push_back(line({{0, 10.0 * i}, {40, 10.0 * i}}));
    c.parts.push_back(line({{10.0 * i, 0}, {10.0 * i, 40}}));
  }
  expect_sound(c);
}

TEST(VoronoiDiagram, TiesAreOneVertexAndNeedNoPrecision) {
  ZoneCase c;  // blocks cut where streets meet, with a vertex in the middle of each side
  for (int i = 0; i < 4; ++i) {
    std::vector<Point> east, north;
    for (int k = 0; k <= 6; ++k) east.push_back({5.0 * k, 10.0 * i}), north.push_back({10.0 * i, 5.0 * k});
    c.parts.push_back(line(east)), c.parts.push_back(line(north));
  }
  expect_sound(c);
  const auto diagram = VoronoiDiagram::build(shared(c));
  EXPECT_EQ(diagram->counters().faces_in_pairs, 0u);
  // Inside each of the nine blocks eight edges meet in the middle: from the corners, and from the middles of the sides. Of
  // these, one that is the face of a vertex has two sides.
  int half_edges = 0;
  for (const auto& edge : diagram->edges()) {
    const Point p = edge.start_clearance > edge.end_clearance ? edge.start : edge.end;
    const bool inside = p.x > 0 && p.x < 30 && p.y > 0 && p.y < 30;
    if (inside && std::max(edge.start_clearance, edge.end_clearance) == 5) half_edges += edge.touches_site ? 1 : 2;
  }
  EXPECT_EQ(half_edges, 2 * 9 * 8);
}

/// Ends of segments look straight at sides, at right angles and in straight lines; everything ties.
TEST(VoronoiDiagram, OutlinesOfPixelsNeedNoPrecision) {
  constexpr int size = 24;
  std::mt19937_64 random(1);
  std::vector<char> full((size + 2) * (size + 2));
  const auto at = [&](int i, int k) -> char& { return full[std::size_t(i * (size + 2) + k)]; };
  for (int i = 1; i <= size; ++i)
    for (int k = 1; k <= size; ++k) at(i, k) = random() % 2 != 0;
  ZoneCase c;
  for (int i = 0; i <= size; ++i) {
    for (int k = 0; k <= size; ++k) {
      const double x = k, y = i;
      if (at(i, k) != at(i + 1, k)) c.parts.push_back(line({{x, y}, {x + 1, y}}));
      if (at(i, k) != at(i, k + 1)) c.parts.push_back(line({{x, y}, {x, y + 1}}));
    }
  }
  expect_sound(c);
  const auto diagram = VoronoiDiagram::build(shared(c));
  ASSERT_TRUE(diagram.ok());
  EXPECT_EQ(diagram->counters().faces_in_pairs, 0u);
}

/// A long segment beside a line of `count` short ones, nearly all of which its side has for neighbours.
ZoneCase long_side_beside_a_fine_line(int count) {
  std::mt19937_64 random(20060403);
  std::uniform_real_distribution<double> unit(-0.02, 0.02);
  std::vector<Point> fine;
  for (int i = 0; i <= count; ++i) fine.push_back({double(i), 20 + unit(random)});
  return {{line({{0, 0}, {double(count), 0}}), line(fine)}};
}

TEST(VoronoiDiagram, ALongSideBesideAFineLine) { expect_sound(long_side_beside_a_fine_line(800)); }

/// Work grows with the size, whatever a side's number of neighbours.
TEST(VoronoiDiagram, ALongSideBesideAFineLineIsNotQuadratic) {
  const auto network = shared(long_side_beside_a_fine_line(10000));
  const auto diagram = VoronoiDiagram::build(network);
  ASSERT_TRUE(diagram.ok()) << diagram.error().text();
  EXPECT_EQ(diagram->validate().value_or("sound"), "sound");
  std::size_t neighbours = 0;
  for (const auto& e : diagram->edges()) {
    for (const auto& site : {e.left, e.right}) neighbours += !site.is_vertex && site.index == 0 ? 1 : 0;
  }
  EXPECT_GT(neighbours, 10000u);
  const auto& counters = diagram->counters();
  EXPECT_LT(counters.candidates, 7 * counters.faces);
  const auto zone = diagram->zone({9.99}), by_intervals = compute_zone(network, {9.99});
  ASSERT_TRUE(zone.ok() && by_intervals.ok());
  EXPECT_EQ(difference(*by_intervals, *zone).value_or("same"), "same");
}

/// Ends of many short lines look far, and often the last site that cuts their face closes it.
TEST(VoronoiDiagram, ScatteredLinesNeedFewCandidates) {
  std::mt19937_64 random(20060404);
  std::uniform_real_distribution<double> unit(0, 1);
  ZoneCase c;
  for (int i = 0; i < 4000; ++i) {
    Point p{1000 * unit(random), 1000 * unit(random)};
    std::vector<Point> points{p};
    for (int k = 0; k < 5; ++k) points.push_back(p = {p.x + unit(random), p.y + unit(random)});
    c.parts.push_back(line(points));
  }
  const auto diagram = VoronoiDiagram::build(shared(c));
  ASSERT_TRUE(diagram.ok()) << diagram.error().text();
  EXPECT_LT(double(diagram->counters().candidates), 5.8 * double(diagram->counters().faces));
}

/// Two segments that overlap but for the move of vertices, and a third at twice the radius: all along the middle the
/// clearance is the radius, whatever the precision says of where the overlap's own bisector meets it.
TEST(VoronoiDiagram, ClearanceBesideAnOverlapIsExact) {
  const auto network = shared({{line({{39e7, 2e7}, {45e7, 10e7}}), line({{16e7, -12e7}, {40e7, 20e7}}),
                                line({{34e7, 12e7}, {37e7, 16e7}})}});
  const auto diagram = VoronoiDiagram::build(network);
  ASSERT_TRUE(diagram.ok()) << diagram.error().text();
  constexpr double between = 5e7;
  int on_the_middle = 0;
  for (const auto& edge : diagram->edges()) {
    for (const double clearance : {edge.start_clearance, edge.end_clearance}) {
      if (std::abs(clearance - between) > 1) continue;
      EXPECT_NEAR(clearance, between, 1e-6);  // a unit in the last place is 6e-8
      ++on_the_middle;
    }
  }
  EXPECT_GE(on_the_middle, 6);
}

TEST(VoronoiDiagram, FoldedSegmentsAtOneVertex) {
  for (const double length : {0.00390625, 0.5, 1.0 / 3}) {
    const ZoneCase c{{line({{0, 0}, {1, 0}}), line({{length, 0}, {0, 0}})}};
    expect_sound(c);
    const auto network = shared(c);
    const auto zone = VoronoiDiagram::build(network)->zone({0.125});
    ASSERT_TRUE(zone.ok()) << zone.error().text();
    EXPECT_EQ(zone->ring_count(), 1u);
    EXPECT_NEAR(zone->area(), 0.25 + M_PI / 64, 1e-12);
  }
}

/// Their bisector leads away to the horizon, and where it gets there rounding of one view of it does not tell.
TEST(VoronoiDiagram, EndsNextToEachOtherOnTheHull) {
  expect_sound({{line({{-7.9984776461706728, 13.454529175907194}, {0.77943593285942225, 3.0647152603897894}}),
                 line({{-1.5058433946984011, 6.908866453379936}, {-7.9984776462335727, 13.454529175809231},
                       {-5.6511632667268534, 6.0053604165609205}})}});
}

TEST(VoronoiDiagram, ControlPointsMakeParabolasExact) {
  const auto diagram = VoronoiDiagram::build(shared({{line({{-10, 1}, {10, 1}}), point(0, 5)}}));
  int parabolas = 0;
  for (const auto& edge : diagram->edges()) {
    const auto control = diagram->control_point(edge, 20);
    EXPECT_EQ(control.has_value(), edge.parabolic);
    if (!control) continue;
    ++parabolas;
    const auto ends = diagram->points(edge, 1e9, 20);
    for (const double t : {0.0, 0.3, 0.5, 0.9, 1.0}) {
      const double u = (1 - t) * (1 - t), v = 2 * t * (1 - t), w = t * t;
      const double x = u * ends.front().x + v * control->x + w * ends.back().x;
      EXPECT_NEAR(u * ends.front().y + v * control->y + w * ends.back().y, (x * x + 16) / 8 + 1, 1e-12);
    }
  }
  EXPECT_GT(parabolas, 0);
}

TEST(VoronoiDiagram, RandomSegmentsThatCross) {
  std::mt19937_64 random(seed());
  std::uniform_real_distribution<double> place(-100, 100), shift(-15, 15);
  for (int run = 0; run < int(20 * effort()) + 1; ++run) {
    ZoneCase c;
    for (int i = 0; i < 40; ++i) {
      const Point p{place(random), place(random)};
      c.parts.push_back(
          line({p, {p.x + shift(random), p.y + shift(random)}, {p.x + shift(random), p.y + shift(random)}}));
    }
    expect_sound(c);
  }
}

TEST(VoronoiDiagram, RadiusBeyondTheHorizonIsRefused) {
  const auto diagram = VoronoiDiagram::build(shared({{line({{0, 0}, {1, 0}})}}));
  const auto zone = diagram->zone({1e7});
  ASSERT_FALSE(zone.ok());
  EXPECT_EQ(zone.error().code, ErrorCode::usage);
  EXPECT_FALSE(diagram->zone({-1}).ok());
}

TEST(VoronoiDiagram, SameForAnyNumberOfThreads) {
  std::mt19937_64 random(seed());
  std::uniform_real_distribution<double> step(-1, 1);
  ZoneCase c;
  for (int i = 0; i < 60; ++i) {
    std::vector<Point> vertices{{30 * step(random), 30 * step(random)}};
    for (int k = 0; k < 100; ++k)
      vertices.push_back({vertices.back().x + step(random), vertices.back().y + step(random)});
    c.parts.push_back(line(vertices));
  }
  const auto network = shared(c);
  std::vector<VoronoiDiagram::Edge> first;
  std::vector<double> areas;
  const std::vector<double> radii{0.1, 0.3, 0.5, 0.7, 1, 2};
  for (const unsigned threads : {1u, 2u, 5u}) {
    Context context;
    context.threads = threads;
    const auto diagram = VoronoiDiagram::build(network, context);
    ASSERT_TRUE(diagram.ok()) << diagram.error().text();
    const auto edges = diagram->edges();
    const auto zones = diagram->zones(radii, context);
    ASSERT_TRUE(zones.ok());
    if (first.empty()) first = edges;
    ASSERT_EQ(first.size(), edges.size());
    for (std::size_t i = 0; i < edges.size(); ++i) {
      ASSERT_TRUE(edges[i].start == first[i].start && edges[i].end == first[i].end &&
                  edges[i].minimum == first[i].minimum);
    }
    std::vector<double> now;
    for (const Zone& zone : *zones) now.push_back(zone.area());
    if (areas.empty()) areas = now;
    EXPECT_EQ(areas, now);
  }
}

}  // namespace
}  // namespace krepl::test
