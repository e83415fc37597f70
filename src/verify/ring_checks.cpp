// Checks of the rings as rings: closed, not crossing, holes where they belong.
#include <algorithm>
#include <string>

#include "verify/zone_checks.hpp"

namespace krepl::verify {

namespace {

/// Of vast circles differences of squares tell nothing: their arcs count as chords, and what is found so is polished.
bool is_vast(const Curve& e) { return e.bow && e.bow->is_short() && e.r > 0x1p10L * distance(e.a, e.b); }
bool is_round(const Curve& e) { return e.arc && !is_vast(e); }

/// How far a place is from the curve's line or circle, with a sign, and the direction in which that grows.
Real off(const Curve& e, Vec p, Vec& out) {
  if (!e.arc) {
    const Vec n = left_of(e.b - e.a);
    out = (1 / length(n)) * n;
    return dot(out, p - e.a);
  }
  const Vec d = e.bow ? (p - e.bow->a) - e.bow->to_centre : p - e.c;
  out = (1 / length(d)) * d;
  return e.bow ? e.bow->off_circle(p) : length(d) - e.r;
}

/// The place near p where both curves are, by Newton's method; from far away it needs some steps.
Vec polished(const Curve& e, const Curve& f, Vec p) {
  for (int k = 0; k < 30; ++k) {
    Vec m, n;
    const Real g = off(e, p, m), h = off(f, p, n), turn = cross(m, n);
    if (std::abs(turn) < 1e-15L) return p;
    const Vec step = (1 / turn) * Vec(h * m.y - g * n.y, g * n.x - h * m.x);
    p = p + step;
    if (length(step) <= 1e-18L * (std::abs(p.x) + std::abs(p.y))) return p;
  }
  return p;
}

/// Points where the full lines or circles of two curves meet; at most two.
int meetings(const Curve& p, const Curve& q, Vec (&out)[2]) {
  if (!is_round(p) && !is_round(q)) {
    const Vec u = p.b - p.a, v = q.b - q.a;
    const Real turn = cross(u, v);
    if (turn == 0) return 0;
    out[0] = p.a + (cross(q.a - p.a, v) / turn) * u;
    return 1;
  }
  Vec base, across;  // meetings at base +- across
  Real square;
  if (is_round(p) && is_round(q)) {
    const Vec d = q.c - p.c;
    const Real dd = dot(d, d);
    if (dd == 0) return 0;
    const Real along = ((p.r - q.r) * (p.r + q.r) + dd) / 2;
    base = p.c + (along / dd) * d;
    square = p.r * p.r - along * along / dd;
    across = (1 / std::sqrt(dd)) * left_of(d);
  } else {
    const Curve& line = is_round(p) ? q : p;
    const Curve& circle = is_round(p) ? p : q;
    const Vec d = line.b - line.a;
    const Real l = length(d);
    if (l == 0) return 0;
    across = (1 / l) * d;
    base = line.a + dot(circle.c - line.a, across) * across;
    const Real h = distance(base, circle.c);
    square = (circle.r - h) * (circle.r + h);
  }
  if (square < 0) return 0;
  const Real half = std::sqrt(square);
  out[0] = base + half * across, out[1] = base - half * across;
  return 2;
}

bool within(const Curve& e, Vec p) {
  // Curves that are all but parallel meet anywhere, and from afar everything is in the same direction.
  const Box box = e.box();
  const Real beside = 1e-9L * (box.x1 - box.x0 + box.y1 - box.y0);
  if (!(box.square_distance(p) <= beside * beside)) return false;
  if (e.bow) return e.bow->spans(p);
  if (is_round(e)) return e.sweeps(p - e.c);
  const Vec d = e.b - e.a;
  const Real t = dot(p - e.a, d);
  return t > 0 && t < dot(d, d);
}

Vec tangent(const Curve& e, Vec p) {
  const Vec d = e.bow ? left_of((p - e.bow->a) - e.bow->to_centre) : e.arc ? left_of(p - e.c) : e.b - e.a;
  const Real l = length(d);
  return l > 0 ? (1 / l) * d : Vec();
}

/// How deep two curves cross: sine of the angle times the length on which they stay crossed. Zero if they do not.
Real crossing_depth(const Curve& p, const Curve& q, Vec& where) {
  Vec m[2];
  const int count = meetings(p, q, m);
  if (is_vast(p) || is_vast(q))
    for (int k = 0; k < count; ++k) m[k] = polished(p, q, m[k]);
  Real deepest = 0;
  for (int k = 0; k < count; ++k) {
    if (!within(p, m[k]) || !within(q, m[k])) continue;
    Real reach = std::min(std::min(distance(m[k], p.a), distance(m[k], p.b)),
                          std::min(distance(m[k], q.a), distance(m[k], q.b)));
    // Two curves that meet twice enclose a lens; its depth is a fraction of its length.
    if (count == 2 && within(p, m[1 - k]) && within(q, m[1 - k])) reach = std::min(reach, distance(m[0], m[1]) / 4);
    const Real depth = std::abs(cross(tangent(p, m[k]), tangent(q, m[k]))) * reach;
    if (depth > deepest) deepest = depth, where = m[k];
  }
  return deepest;
}

/// True if the rings around a point of ring r are as they must be. Around a hole: its own outer ring, and pairs of outer
/// rings and holes that enclose the whole polygon; around an outer ring such pairs only. So the others must balance.
bool nested_at(const Boundary& boundary, std::uint32_t r, Vec p) {
  const auto& rings = boundary.rings();
  std::vector<std::uint32_t> around;
  boundary.rings_around(p, around);
  int balance = 0;
  bool own_outer = false;
  for (const std::uint32_t k : around) {
    if (k == r) continue;
    balance += rings[k].hole ? -1 : 1;
    if (rings[k].polygon != rings[r].polygon) continue;
    if (rings[k].hole && rings[r].hole) return false;  // holes overlap
    own_outer |= !rings[k].hole;
  }
  return rings[r].hole ? own_outer && balance == 1 : balance == 0;
}

}  // namespace

Check check_joins(const ZoneCase& zone) {
  const auto& curves = zone.boundary.curves().items();
  Tally tally;
  for (const Boundary::Ring& ring : zone.boundary.rings()) {
    if (ring.first == ring.last) tally.add(HUGE_VALL, zone.tolerance, Vec());
    for (std::uint32_t i = ring.first; i < ring.last; ++i) {
      const Curve& next = curves[i + 1 < ring.last ? i + 1 : ring.first];
      tally.add(distance(curves[i].b, next.a), zone.tolerance, curves[i].b);
    }
  }
  return tally.check("pieces join end to end", zone.tolerance);
}

// Tangent pieces of a true zone may cross by rounding; a crossing counts when it is deeper than the tolerance, for
// linear formats too: chords may be off, but must not cross.
Check check_crossings(const ZoneCase& zone) {
  const auto& curves = zone.boundary.curves();
  const Tally tally = tally_all(zone.context, curves.items().size(), [&](std::size_t i, Tally& t) {
    const Curve& p = curves.items()[i];
    Vec where = p.a;
    Real deepest = 0;
    curves.for_each_in(p.box(), [&](std::uint32_t j) {
      if (j <= i) return;
      Vec at;
      const Real depth = crossing_depth(p, curves.items()[j], at);
      if (depth > deepest) deepest = depth, where = at;
    });
    t.add(deepest, zone.tolerance, where);
  });
  return tally.check("rings do not cross", zone.tolerance);
}

Check check_nesting(const ZoneCase& zone) {
  const auto& curves = zone.boundary.curves().items();
  const auto& rings = zone.boundary.rings();
  std::size_t turned = 0;
  for (const auto& ring : rings) turned += ring.turned;
  Tally tally = tally_all(zone.context, rings.size(), [&](std::size_t r, Tally& t) {
    const Boundary::Ring& ring = rings[r];
    if (ring.first == ring.last) return;
    const Curve& longest = *std::max_element(curves.begin() + ring.first, curves.begin() + ring.last,
                                             [](const Curve& p, const Curve& q) { return p.length() < q.length(); });
    // Rings may touch in single points, where rounding decides; no two of these three are likely to be such.
    int right = 0;
    for (const Real at : {0.217L, 0.5L, 0.841L}) right += nested_at(zone.boundary, std::uint32_t(r), longest.at(at));
    t.add(right >= 2 ? 0 : longest.length(), 0, longest.at(0.5L));
  });
  Check check = tally.check("holes in their outer rings", 0);
  if (turned > 0) check.note = std::to_string(turned) + " rings run the other way round";
  return check;
}

}  // namespace krepl::verify
