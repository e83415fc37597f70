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

struct Measures {
  double area = 0;    ///< between the boundary and the x axis
  double length = 0;  ///< of the boundary without its half-lines
  double turning = 0; ///< of all arcs, in radians
};

Measures measures_of(const Profile& profile) {
  Measures m;
  const double r = profile.radius;
  for (std::size_t k = 1; k + 1 < profile.pieces.size(); ++k) {
    const ProfileRow row = profile.row(k);
    const double width = row.end.x - row.start.x;
    if (row.kind != Kind::arc) {
      m.area += width * (row.start.y + row.end.y) / 2;
      m.length += std::hypot(width, row.end.y - row.start.y);
      continue;
    }
    const Point s{row.start.x - row.center.x, row.start.y - row.center.y};
    const Point e{row.end.x - row.center.x, row.end.y - row.center.y};
    const double angle = std::fabs(std::atan2(s.y * e.x - s.x * e.y, s.x * e.x + s.y * e.y));
    m.area += width * row.center.y + (e.x * e.y - s.x * s.y + r * r * angle) / 2;
    m.length += r * angle;
    m.turning += angle;
  }
  return m;
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
  const Measures m = measures_of(left), n = measures_of(right);
  const double size = (terrain.back().x + 2 * r + 10) * (r + 10);
  RC_ASSERT(std::fabs(m.area - n.area) < 1e-12 * size);
  RC_ASSERT(std::fabs(m.length - n.length) < 1e-7 * size);  // an end where circles touch is known to half the digits
  RC_ASSERT(std::fabs(m.turning - n.turning) < 1e-6);
  const auto fault = fault_in(mirrored(terrain), r);
  if (fault) RC_FAIL(*fault);
}

/// The boundary as a terrain of chords, ends on it, 400 to an arc; without the half-lines.
Terrain chords_of(const Profile& profile) {
  Terrain chords;
  const auto add = [&](Point p) {
    if (!chords.empty()) p.x = std::max(p.x, chords.back().x);  // rounding at the ends of half circles
    chords.push_back(p);
  };
  for (std::size_t k = 1; k + 1 < profile.pieces.size(); ++k) {
    const ProfileRow row = profile.row(k);
    add(row.start);
    if (row.kind != Kind::arc) continue;
    const Point c = row.center;
    const double from = std::atan2(row.start.y - c.y, row.start.x - c.x), to = std::atan2(row.end.y - c.y, row.end.x - c.x);
    for (int i = 1; i < 400; ++i) {
      const double angle = from + (to - from) * i / 400;
      add({c.x + profile.radius * std::cos(angle), c.y + profile.radius * std::sin(angle)});
    }
  }
  add(profile.pieces.back().start);
  return chords;
}

RC_GTEST_PROP(Properties, TwoDisksOneAfterTheOther, ()) {
  // T (+) a (+) b = T (+) (a + b), but for the height of the chords below their arcs.
  const Terrain terrain = *lattice_terrain();
  const double a = drawn_radius(), b = drawn_radius();
  const Profile both = profile_of(terrain, a + b), second = profile_of(chords_of(profile_of(terrain, a)), b);
  const double sagitta = a * (1 - std::cos(std::acos(-1.0) / 800));
  const Measures m = measures_of(both), n = measures_of(second);
  RC_ASSERT(n.area <= m.area + 1e-9 * m.length);
  RC_ASSERT(n.area >= m.area - (sagitta + 1e-9) * m.length);
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
