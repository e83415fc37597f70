// The verifier passes right zones that are written by hand here (no engine), and catches each planted fault.
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "support/environment.hpp"
#include "support/zone_case.hpp"
#include "verify/boundary.hpp"

namespace krepl::test {
namespace {

using input::ResultPiece;
using input::ResultPolygon;
using input::ResultRing;
using verify::Check;
using verify::Obstacle;
using verify::Vec;
using verify::ZoneCheckOptions;
using verify::ZoneReport;

ResultPiece segment(Point a, Point b) { return {false, a, {}, b}; }

/// Arc about c from angle `from` to `to` (degrees, counter-clockwise where `to` is larger).
ResultPiece arc(Point c, double r, double from, double to) {
  const auto at = [&](double degrees) {
    const double a = degrees * std::numbers::pi / 180;
    return Point{c.x + r * std::cos(a), c.y + r * std::sin(a)};
  };
  return {true, at(from), at((from + to) / 2), at(to)};
}

/// Makes ends meet exactly where they differ by rounding only.
ResultRing closed(std::vector<ResultPiece> pieces) {
  for (std::size_t i = 0; i < pieces.size(); ++i) pieces[i].end = pieces[(i + 1) % pieces.size()].start;
  return {std::move(pieces)};
}

struct Example {
  std::vector<InputPart> input;
  double radius;
  std::vector<ResultPolygon> zone;
};

/// A closed square of side 10 as a line: an outer ring with four arcs and a square hole.
Example square() {
  Example e{{line({{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}})}, 1, {}};
  e.zone.push_back(
      {closed({segment({0, -1}, {10, -1}), arc({10, 0}, 1, -90, 0), segment({11, 0}, {11, 10}), arc({10, 10}, 1, 0, 90),
               segment({10, 11}, {0, 11}), arc({0, 10}, 1, 90, 180), segment({-1, 10}, {-1, 0}),
               arc({0, 0}, 1, 180, 270)}),
       {closed({segment({1, 1}, {1, 9}), segment({1, 9}, {9, 9}), segment({9, 9}, {9, 1}), segment({9, 1}, {1, 1})})}});
  return e;
}

/// The same square as a polygon, with a point far away.
Example filled() {
  Example e = square();
  e.input[0].ring = true;
  e.input.push_back(point(30, 5));
  e.zone[0].holes.clear();
  e.zone.push_back({closed({arc({30, 5}, 1, 0, 360)}), {}});
  return e;
}

/// Two parallels that share a zone by their caps' overlap, in coordinates of UTM size.
Example far_away() {
  const double x = 512345, y = 4612345;
  Example e{{line({{x, y}, {x + 20, y}}), line({{x + 20, y}, {x + 20, y + 16}})}, 2, {}};
  e.zone.push_back({closed({segment({x, y - 2}, {x + 20, y - 2}), arc({x + 20, y}, 2, -90, 0),
                            segment({x + 22, y}, {x + 22, y + 16}), arc({x + 20, y + 16}, 2, 0, 180),
                            segment({x + 18, y + 16}, {x + 18, y + 2}), segment({x + 18, y + 2}, {x, y + 2}),
                            arc({x, y}, 2, 90, 270)}),
                    {}});
  return e;
}

ZoneReport check(const Example& e, double max_error = 0) {
  ZoneCheckOptions options;
  options.radius = e.radius, options.max_error = max_error, options.effort = 0.1;
  auto report = verify::check_zone(e.zone, Obstacle(e.input), options);
  EXPECT_TRUE(report.ok()) << report.error().text();
  return *report;
}

std::string failures(const ZoneReport& report) {
  std::string names;
  for (const Check& c : report.checks)
    if (!c.ok()) names += c.name + "; ";
  return names;
}

TEST(ZoneVerifier, PassesRightZones) {
  for (const Example& e : {square(), filled(), far_away()}) {
    const ZoneReport report = check(e);
    EXPECT_EQ(failures(report), "");
    for (const Check& c : report.checks)
      EXPECT_TRUE(c.name.find("about input") != std::string::npos || c.tested > 0) << c.name;
  }
  EXPECT_NEAR(check(square()).area, 140 + std::numbers::pi - 64, 1e-12);
  EXPECT_NEAR(check(filled()).area, 140 + 2 * std::numbers::pi, 1e-12);
}

TEST(ZoneVerifier, PassesRingsThatRunTheOtherWayRound) {
  Example e = square();
  for (ResultRing* ring : {&e.zone[0].outer, &e.zone[0].holes[0]}) {
    std::reverse(ring->pieces.begin(), ring->pieces.end());
    for (ResultPiece& p : ring->pieces) std::swap(p.start, p.end);
  }
  EXPECT_EQ(failures(check(e)), "");
}

/// Faults and the check that must see them (others may as well).
struct Fault {
  const char* what;
  const char* seen_by;
  std::function<void(Example&)> plant;
};

const Fault faults[] = {
    {"another radius", "distance of the boundary", [](Example& e) { e.radius *= 1 + 1e-6; }},
    {"a vertex moved a little", "distance of the boundary",
     [](Example& e) { e.zone[0].outer.pieces[0].start.y += 1e-6, e.zone[0].outer.pieces.back().end.y += 1e-6; }},
    {"pieces that do not join", "pieces join end to end", [](Example& e) { e.zone[0].outer.pieces[2].end.y += 1e-6; }},
    {"an arc about nothing", "arcs about input vertices",
     [](Example& e) { e.zone[0].outer.pieces[1].middle.x += 1e-5; }},
    {"an arc the long way round", "distance of the boundary",
     [](Example& e) {
       ResultPiece& p = e.zone[0].outer.pieces[1];
       const Point c{10, 0};
       p.middle = {2 * c.x - p.middle.x, 2 * c.y - p.middle.y};
     }},
    {"a hole lost", "membership of points", [](Example& e) { e.zone[0].holes.clear(); }},
    {"a hole lost, seen from the input", "input's sides on the boundary", [](Example& e) { e.zone[0].holes.clear(); }},
    {"a hole lost, seen by area", "area by strips", [](Example& e) { e.zone[0].holes.clear(); }},
    {"a hole lost, seen by lines", "area between on lines", [](Example& e) { e.zone[0].holes.clear(); }},
    {"a hole too many", "distance of the boundary",
     [](Example& e) {
       e.zone[0].holes.push_back(
           closed({segment({2, 0.2}, {3, 0.2}), segment({3, 0.2}, {2.5, 0.4}), segment({2.5, 0.4}, {2, 0.2})}));
     }},
    {"a hole as an island", "holes in their outer rings",
     [](Example& e) {
       e.zone.push_back({e.zone[0].holes[0], {}}), e.zone[0].holes.clear();
     }},
    {"a hole twice", "membership of points", [](Example& e) { e.zone[0].holes.push_back(e.zone[0].holes[0]); }},
    {"a hole inside a hole", "holes in their outer rings",
     [](Example& e) {
       e.zone[0].holes.push_back(closed({segment({2, 2}, {2, 8}), segment({2, 8}, {8, 8}), segment({8, 8}, {2, 2})}));
     }},
    {"a hole of another polygon", "holes in their outer rings",
     [](Example& e) {
       e.input.push_back(point(40, 40));
       e.zone.push_back({closed({arc({40, 40}, 1, 0, 360)}), e.zone[0].holes});
       e.zone[0].holes.clear();
     }},
    {"a polygon twice", "membership of points", [](Example& e) { e.zone.push_back(e.zone[0]); }},
    {"a part of the input left out", "input's sides on the boundary",
     [](Example& e) { e.input.push_back(point(50, 50)); }},
    {"a part of the input left out, inside a hole", "membership of points",
     [](Example& e) { e.input.push_back(point(5, 5)); }},
    {"an input vertex too many for an arc", "distance of the boundary",
     [](Example& e) { e.input.push_back(point(10.01, 0)); }},
    {"rings that cross", "rings do not cross",
     [](Example& e) {
       auto& h = e.zone[0].holes[0].pieces;
       h[0].start = h[3].end = {-2, 5};
     }},
    {"a ring without pieces", "pieces join end to end", [](Example& e) { e.zone[0].holes.push_back({}); }},
    {"no result at all", "input's sides on the boundary", [](Example& e) { e.zone.clear(); }},
};

TEST(ZoneVerifier, CatchesPlantedFaults) {
  for (const Fault& fault : faults) {
    Example e = square();
    fault.plant(e);
    const ZoneReport report = check(e);
    EXPECT_FALSE(report.ok()) << fault.what;
    EXPECT_NE(failures(report).find(fault.seen_by), std::string::npos)
        << fault.what << ", seen by " << failures(report);
  }
}

TEST(ZoneVerifier, CatchesABoundaryInsideAPolygon) {
  Example e = filled();
  e.zone[0].holes = square().zone[0].holes;  // at distance R of the sides, but of a filled polygon
  const std::string seen = failures(check(e));
  EXPECT_NE(seen.find("distance of the boundary"), std::string::npos) << seen;
  EXPECT_NE(seen.find("membership"), std::string::npos) << seen;
}

TEST(ZoneVerifier, AllowsChordsOnlyWithinMaxError) {
  Example e{{point(0, 0)}, 1, {}};
  const int n = 200;
  std::vector<ResultPiece> chords;
  for (int k = 0; k < n; ++k) {
    const double a = 2 * std::numbers::pi * k / n;
    chords.push_back(segment({std::cos(a), std::sin(a)}, {}));
  }
  e.zone.push_back({closed(std::move(chords)), {}});
  const double sagitta = 1 - std::cos(std::numbers::pi / n);
  EXPECT_FALSE(check(e).ok());
  EXPECT_FALSE(check(e, 0.9 * sagitta).ok());
  EXPECT_EQ(failures(check(e, 1.01 * sagitta)), "");
}

TEST(ZoneVerifier, ReportsTheWorstErrorAndItsPlace) {
  Example e = square();
  e.zone[0].outer.pieces[2].end = e.zone[0].outer.pieces[3].start = {11, 10.25};
  const ZoneReport report = check(e);
  const auto found = std::find_if(report.checks.begin(), report.checks.end(),
                                  [](const Check& c) { return c.name == "distance of the boundary"; });
  ASSERT_NE(found, report.checks.end());
  EXPECT_NEAR(found->worst, std::hypot(1, 0.25) - 1, 1e-3);
  EXPECT_NEAR(found->where.x, 11, 0.1);
  EXPECT_NEAR(found->where.y, 10.25, 0.1);
}

TEST(ZoneVerifier, RefusesWhatItCannotCheck) {
  Example e = square();
  const Obstacle obstacle(e.input);
  EXPECT_FALSE(verify::check_zone(e.zone, obstacle, {.radius = 0}).ok());
  EXPECT_FALSE(verify::check_zone(e.zone, obstacle, {.radius = std::nan("")}).ok());
  EXPECT_FALSE(verify::check_zone(e.zone, Obstacle({}), {.radius = 1}).ok());
  e.zone[0].outer.pieces[0].start.x = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(verify::check_zone(e.zone, obstacle, {.radius = 1}).ok());
}

TEST(ZoneVerifier, DoesNotDependOnTheNumberOfThreads) {
  Example e = far_away();
  e.radius *= 1 + 1e-12;
  ZoneCheckOptions options;
  options.radius = e.radius, options.effort = 0.1;
  Context one, three;
  one.threads = 1, three.threads = 3;
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, 3);
  const Obstacle obstacle(e.input);
  const auto a = verify::check_zone(e.zone, obstacle, options, one),
             b = verify::check_zone(e.zone, obstacle, options, three);
  ASSERT_TRUE(a.ok() && b.ok());
  for (std::size_t i = 0; i < a->checks.size(); ++i) {
    EXPECT_EQ(a->checks[i].worst, b->checks[i].worst);
    EXPECT_EQ(a->checks[i].where, b->checks[i].where);
    EXPECT_EQ(a->checks[i].tested, b->checks[i].tested);
  }
}

// The tree that makes the brute force affordable, against none.
TEST(ZoneVerifier, NearestTreeFindsTheNearest) {
  std::mt19937_64 random(seed());
  const auto unit = [&] { return double(random() >> 11) * 0x1p-53; };
  for (const std::size_t n : {1u, 2u, 7u, 100u, 1000u}) {
    std::vector<InputPart> parts;
    for (std::size_t i = 0; i < n; ++i) {
      const Point a{unit(), unit()};
      const double size = i % 10 == 0 ? 1 : 0.01;
      parts.push_back(i % 7 == 0 ? line({a}) : line({a, {a.x + size * (unit() - 0.5), a.y + size * (unit() - 0.5)}}));
    }
    const Obstacle obstacle(parts);
    for (int k = 0; k < 300; ++k) {
      const Vec p(3 * unit() - 1, 3 * unit() - 1);
      long double nearest = HUGE_VALL;
      for (const auto& s : obstacle.segments().items())
        nearest = std::min(nearest, verify::distance_to_segment(p, s.a, s.b));
      EXPECT_EQ(obstacle.distance(p), nearest);
    }
  }
}

}  // namespace
}  // namespace krepl::test
