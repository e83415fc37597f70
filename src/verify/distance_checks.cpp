// Checks of where the boundary is: on its true place, everywhere there, and with the right side inside.
#include <algorithm>
#include <atomic>
#include <string>

#include "verify/zone_checks.hpp"

namespace krepl::verify {

namespace {

constexpr Real pi = 3.141592653589793238462643383279502884L;

}  // namespace

std::size_t per_item(std::size_t items, double budget, std::size_t least, std::size_t most, double effort) {
  const std::size_t top = std::max(least, std::size_t(double(most) * std::min(1.0, 5 * effort)));
  return items == 0 ? top : std::clamp(std::size_t(effort * budget / double(items)), least, top);
}

Vec sample_point(const ZoneCase& zone, const Box& region, std::size_t i) {
  Random random(zone.seed, i);
  const auto& curves = zone.boundary.curves().items();
  const std::size_t kind = curves.empty() ? i % 2 : i % 4;
  if (kind == 0)
    return {region.x0 + random.unit() * (region.x1 - region.x0), region.y0 + random.unit() * (region.y1 - region.y0)};
  if (kind == 1) {
    const auto& segments = zone.obstacle.segments().items();
    const auto& s = segments[random.below(segments.size())];
    const Real t = random.unit(), far = 1.5L * zone.radius * random.unit(), angle = 2 * pi * random.unit();
    const Vec foot = s.arc ? s.arc->at(t) : Vec(s.a) + t * (Vec(s.b) - Vec(s.a));
    return foot + far * Vec(std::cos(angle), std::sin(angle));
  }
  const Curve& curve = curves[random.below(curves.size())];
  const Real t = random.unit();
  const Real sign = random.unit() < 0.5L ? -1 : 1;
  const Real close = std::max(1e-6L * zone.radius, 4 * zone.deviation);
  const Real off = kind == 2 ? close : close + zone.radius * random.unit() * random.unit();
  return curve.at(t) + (sign * off) * curve.normal(t);
}

// Three points fix a short arc's centre only badly, so the input vertex is looked for that has all three at distance R.
Check check_centres(const ZoneCase& zone) {
  const ArcFit& fit = zone.boundary.arc_fit();
  Tally tally;
  tally.tested = fit.arcs, tally.violations = fit.without_centre, tally.worst = fit.worst, tally.where = fit.where;
  return tally.check("arcs about input vertices", zone.tolerance);
}

Check check_distances(const ZoneCase& zone) {
  const auto& curves = zone.boundary.curves().items();
  const std::size_t inner = per_item(curves.size(), 2e6, 3, 32, zone.effort);
  const Tally tally = tally_all(zone.context, curves.size(), [&](std::size_t i, Tally& t) {
    for (std::size_t k = 0; k <= inner; ++k) {
      const Vec p = k == 0 ? curves[i].a : curves[i].at(Real(k) / (inner + 1));
      // The boundary of a zone is at distance R of the lines and never inside a polygon; a band has another at the inner radius.
      const Real d = zone.obstacle.distance(p);
      Real off = std::abs(d - zone.radius);
      if (zone.inner > 0) off = std::min(off, std::abs(d - zone.inner));
      t.add(off, zone.deviation, p);
      if (off <= zone.deviation && zone.obstacle.has_polygons() && zone.obstacle.in_polygon(p))
        t.add(zone.radius, zone.deviation, p);
    }
  });
  return tally.check("distance of the boundary", zone.deviation);
}

Check check_membership(const ZoneCase& zone) {
  Box region = zone.obstacle.box();
  if (!zone.boundary.box().empty()) region.add(zone.boundary.box());
  region = region.grown(zone.radius / 2);
  std::atomic<std::uint64_t> undecided{0};
  Tally tally = tally_all(zone.context, zone.samples, [&](std::size_t i, Tally& t) {
    const Vec p = sample_point(zone, region, i);
    const Real d = zone.obstacle.distance(p);
    const bool in_polygon = zone.obstacle.in_polygon(p);
    const auto is_near = [&](Real radius) { return !in_polygon && std::abs(d - radius) <= zone.deviation; };
    if (is_near(zone.radius) || (zone.inner > 0 && is_near(zone.inner))) {
      undecided.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    const bool hollow = zone.inner > 0 && (in_polygon || d < zone.inner);
    const bool inside = !hollow && (in_polygon || d < zone.radius);
    const bool right = zone.boundary.winding(p) == (inside ? 1 : 0);
    const Real off = std::min(std::abs(d - zone.radius), zone.inner > 0 ? std::abs(d - zone.inner) : zone.radius);
    t.add(right ? 0 : off, 0, p);
  });
  Check check = tally.check("membership of points", 0);
  if (undecided > 0) check.note = std::to_string(undecided.load()) + " too near the boundary to tell";
  return check;
}

// A point at distance R from its own element, moved out by 2 deviations, is outside if nothing else is nearer; it was
// inside before, so the boundary must pass between the two. The same holds at the inner radius of a band.
Check check_coverage(const ZoneCase& zone) {
  const auto& segments = zone.obstacle.segments().items();
  const std::size_t each = per_item(segments.size(), 5e5, 1, 64, zone.effort);
  const Real step = 2 * zone.deviation;
  const auto probe_at = [&](Vec foot, Vec outward, Real radius, Real inset, Tally& t) {
    const Vec p = foot + (radius - inset + step) * outward;
    if (zone.obstacle.distance(p) < radius + step / 2) return;
    if (zone.obstacle.has_polygons() && zone.obstacle.in_polygon(p)) return;
    const Real off = zone.boundary.curves().nearest(p).distance;
    t.add(std::max(Real(0), off - step), zone.deviation, p);
  };
  const auto probe = [&](Vec foot, Vec outward, Real inset, Tally& t) {
    probe_at(foot, outward, zone.radius, inset, t);
    if (zone.inner > 0) probe_at(foot, outward, zone.inner, inset, t);
  };
  const Tally tally = tally_all(zone.context, segments.size(), [&](std::size_t i, Tally& t) {
    Random random(zone.seed + 1, i);
    const Vec a = segments[i].a, b = segments[i].b;
    const Real l = distance(a, b), inset = segments[i].inset;
    for (std::size_t k = 0; k < each; ++k) {
      if (segments[i].arc) {
        const Real fraction = random.unit();
        const Vec foot = segments[i].arc->at(fraction), n = segments[i].arc->normal(fraction);
        probe(foot, n, inset, t), probe(foot, Real(-1) * n, inset, t);
      } else if (l > 0) {
        const Vec n = (1 / l) * left_of(b - a);
        const Vec foot = a + random.unit() * (b - a);
        probe(foot, n, inset, t), probe(foot, Real(-1) * n, inset, t);
      }
      const Real angle = 2 * pi * random.unit();
      probe(k % 2 == 0 ? a : b, Vec(std::cos(angle), std::sin(angle)), inset, t);
    }
  });
  return tally.check("input's sides on the boundary", zone.deviation);
}

}  // namespace krepl::verify
