// What must hold between results, on terrains that rapidcheck draws (and shrinks).
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "terrain_case.hpp"

namespace krepl::test {

namespace {

using Kind = ProfilePiece::Kind;

/// Terrains on a coarse lattice: integer steps 0 .. 3, heights -4 .. 4, so that everything degenerate is common.
rc::Gen<Terrain> lattice_terrain() {
  const auto step = rc::gen::pair(rc::gen::inRange(0, 4), rc::gen::inRange(-4, 5));
  return rc::gen::map(rc::gen::nonEmpty(rc::gen::container<std::vector<std::pair<int, int>>>(step)),
                      [](const std::vector<std::pair<int, int>>& steps) {
                        Terrain t;
                        double x = 0;
                        for (const auto& [dx, y] : steps) t.push_back({x, double(y)}), x += dx;
                        return t;
                      });
}

double drawn_radius() { return double(*rc::gen::inRange(1, 41)) / 4; }

/// Height of the boundary at x, from its pieces; the highest at a wall.
double height(const Profile& profile, double x) {
  double best = -HUGE_VAL;
  for (std::size_t k = 1; k + 1 < profile.pieces.size(); ++k) {
    const ProfileRow row = profile.row(k);
    if (row.start.x > x || row.end.x < x) continue;
    double y;
    if (row.kind == Kind::arc) {
      const double dx = x - row.center.x;
      y = row.center.y + std::sqrt(std::max(0.0, (profile.radius - dx) * (profile.radius + dx)));
    } else if (row.end.x > row.start.x) {
      y = row.start.y + (row.end.y - row.start.y) * ((x - row.start.x) / (row.end.x - row.start.x));
    } else {
      y = std::max(row.start.y, row.end.y);
    }
    best = std::max(best, y);
  }
  return best;
}

/// Points of the boundary: ends and middles of its pieces.
std::vector<Point> places_on(const Profile& profile) {
  std::vector<Point> places;
  for (std::size_t k = 1; k + 1 < profile.pieces.size(); ++k) {
    const ProfileRow row = profile.row(k);
    places.push_back(row.start);
    Point m{(row.start.x + row.end.x) / 2, (row.start.y + row.end.y) / 2};
    if (row.kind == Kind::arc) {
      const Point c = row.center;
      const double l = std::hypot(m.x - c.x, m.y - c.y), f = profile.radius / l;
      m = l > 1e-9 ? Point{c.x + f * (m.x - c.x), c.y + f * (m.y - c.y)} : Point{c.x, c.y + profile.radius};
    }
    places.push_back(m);
  }
  return places;
}

bool near(Point a, Point b, double tolerance) { return std::hypot(a.x - b.x, a.y - b.y) <= tolerance; }

RC_GTEST_PROP(Properties, SoundByBruteForce, ()) {
  const Terrain terrain = *lattice_terrain();
  const double radius = drawn_radius();
  const auto fault = fault_in(terrain, radius);
  if (fault) RC_FAIL(*fault + "\n" + text(terrain, radius));
}

RC_GTEST_PROP(Properties, MonotoneInTheRadius, ()) {
  const Terrain terrain = *lattice_terrain();
  const double r = drawn_radius(), more = drawn_radius();
  const Profile small = profile_of(terrain, r), large = profile_of(terrain, r + more);
  for (const Point p : places_on(small)) RC_ASSERT(height(large, p.x) > p.y);
}

RC_GTEST_PROP(Properties, MonotoneInTheTerrain, ()) {
  const Terrain terrain = *lattice_terrain();
  const double r = drawn_radius();
  Terrain higher = terrain;
  for (Point& p : higher) p.y += *rc::gen::inRange(0, 3);
  const Profile low = profile_of(terrain, r), high = profile_of(higher, r);
  for (const Point p : places_on(low)) RC_ASSERT(height(high, p.x) >= p.y - 1e-7);
}

RC_GTEST_PROP(Properties, ContainsTheTerrainRaisedByTheRadius, ()) {
  const Terrain terrain = *lattice_terrain();
  const double r = drawn_radius();
  const Profile profile = profile_of(terrain, r);
  for (const Point p : terrain) RC_ASSERT(height(profile, p.x) >= p.y + r - 1e-9);
}

RC_GTEST_PROP(Properties, TranslationMovesThePieces, ()) {
  const Terrain terrain = *lattice_terrain();
  const double r = drawn_radius(), dx = *rc::gen::inRange(-1000, 1000), dy = *rc::gen::inRange(-1000, 1000);
  const Profile here = profile_of(terrain, r), there = profile_of(moved(terrain, dx, dy), r);
  RC_ASSERT(here.pieces.size() == there.pieces.size());
  for (std::size_t k = 1; k < here.pieces.size(); ++k) {
    RC_ASSERT(here.pieces[k].kind == there.pieces[k].kind);
    RC_ASSERT(here.pieces[k].index == there.pieces[k].index);
    const Point p = here.pieces[k].start;
    RC_ASSERT(near({p.x + dx, p.y + dy}, there.pieces[k].start, 1e-12 * (2000 + r)));
  }
}

RC_GTEST_PROP(Properties, PowersOfTwoScaleEveryBit, ()) {
  const Terrain terrain = *lattice_terrain();
  const double r = drawn_radius(), factor = std::ldexp(1.0, *rc::gen::inRange(-60, 60));
  const Profile one = profile_of(terrain, r), other = profile_of(scaled(terrain, factor), r * factor);
  RC_ASSERT(one.pieces.size() == other.pieces.size());
  for (std::size_t k = 1; k < one.pieces.size(); ++k) {
    RC_ASSERT(one.pieces[k].index == other.pieces[k].index);
    RC_ASSERT(one.pieces[k].start.x * factor == other.pieces[k].start.x);
    RC_ASSERT(one.pieces[k].start.y * factor == other.pieces[k].start.y);
  }
}

RC_GTEST_PROP(Properties, MirrorImage, ()) {
  const Terrain terrain = *lattice_terrain();
  const double r = drawn_radius();
  const Profile left = profile_of(terrain, r), right = profile_of(mirrored(terrain), r);
  // Causes may differ where walls overlap, and so may the number of pieces; the curve may not.
  for (Point p : places_on(left)) {
    const double y = height(right, -p.x), reach = 1e-9;
    const double low = std::min({y, height(right, -p.x - reach), height(right, -p.x + reach)});
    RC_ASSERT(p.y >= low - 1e-4);
    RC_ASSERT(p.y <= std::max({y, height(right, -p.x - reach), height(right, -p.x + reach)}) + 1e-4);
  }
  const auto fault = fault_in(mirrored(terrain), r);
  if (fault) RC_FAIL(*fault);
}

RC_GTEST_PROP(Properties, TwoDisksOneAfterTheOther, ()) {
  // T (+) a (+) b = T (+) (a + b): every point of the second boundary is at distance b from the first one.
  const Terrain terrain = *lattice_terrain();
  const double a = drawn_radius(), b = drawn_radius();
  const Profile first = profile_of(terrain, a), both = profile_of(terrain, a + b);
  // Chords of the first boundary within 1e-6 of it, ends included.
  Terrain boundary;
  for (std::size_t k = 1; k + 1 < first.pieces.size(); ++k) {
    const ProfileRow row = first.row(k);
    const Point c = row.center;
    const int chords = row.kind == Kind::arc ? 400 : 1;
    double from = 0, to = 0;
    if (row.kind == Kind::arc) {
      from = std::atan2(row.start.y - c.y, row.start.x - c.x), to = std::atan2(row.end.y - c.y, row.end.x - c.x);
    }
    for (int i = 0; i <= chords; ++i) {
      const double angle = from + (to - from) * i / chords;
      const Point p = i == 0 ? row.start : i == chords ? row.end : Point{c.x + a * std::cos(angle), c.y + a * std::sin(angle)};
      if (boundary.empty() || p.x >= boundary.back().x) boundary.push_back(p);
    }
  }
  const Profile second = profile_of(boundary, b);
  const double sagitta = a * 1e-4;
  for (const Point p : places_on(second)) {
    const double reach = 1e-3;
    double high = -HUGE_VAL;
    for (const double x : {p.x - reach, p.x, p.x + reach}) high = std::max(high, height(both, x));
    RC_ASSERT(p.y <= high + sagitta);
  }
  for (const Point p : places_on(both)) {
    const double reach = 1e-3;
    double high = -HUGE_VAL;
    for (const double x : {p.x - reach, p.x, p.x + reach}) high = std::max(high, height(second, x));
    RC_ASSERT(p.y <= high + 0.1 * std::sqrt(b));  // a chord's loss of height, steep at the ends of the domain
  }
}

RC_GTEST_PROP(Properties, AnotherPointOnASegmentChangesNothing, ()) {
  Terrain terrain = *lattice_terrain();
  const double r = drawn_radius();
  const Profile before = profile_of(terrain, r);
  Terrain finer;
  for (std::size_t i = 0; i + 1 < terrain.size(); ++i) {
    finer.push_back(terrain[i]);
    finer.push_back({(terrain[i].x + terrain[i + 1].x) / 2, (terrain[i].y + terrain[i + 1].y) / 2});
  }
  finer.push_back(terrain.back());
  const Profile after = profile_of(finer, r);
  // The same arcs with the same ends; segments are cut in two where the new point shows.
  std::vector<Point> arcs_before, arcs_after;
  for (const Profile* p : {&before, &after})
    for (std::size_t k = 0; k < p->pieces.size(); ++k)
      if (p->pieces[k].kind == Kind::arc) (p == &before ? arcs_before : arcs_after).push_back(p->pieces[k].start);
  RC_ASSERT(arcs_before.size() == arcs_after.size());
  for (std::size_t i = 0; i < arcs_before.size(); ++i) RC_ASSERT(near(arcs_before[i], arcs_after[i], 1e-12 * (40 + r)));
}

}  // namespace

}  // namespace krepl::test
