// Arcs of a curve fit. Coordinates of an arc: x along the chord from its start to its end, y to the left of it; the
// arc's centre is at (c / 2, -1 / bend) with c the chord's length, so that bend > 0 is an arc over a top.
#include <algorithm>
#include <cmath>
#include <limits>

#include "mill/curve_fit.hpp"

namespace krepl::mill {
namespace {

double squared_distance(CurvePoint p, CurvePoint c) { return (p.t - c.t) * (p.t - c.t) + (p.z - c.z) * (p.z - c.z); }

/// Of a segment's points from c.
double least_distance(CurvePoint p, CurvePoint q, CurvePoint c) {
  const double dt = q.t - p.t, dz = q.z - p.z, squared = dt * dt + dz * dz;
  const double along = squared > 0 ? std::clamp(((c.t - p.t) * dt + (c.z - p.z) * dz) / squared, 0.0, 1.0) : 0;
  return std::sqrt(squared_distance({p.t + along * dt, p.z + along * dz}, c));
}

}  // namespace

/// The lowest arc from p to the lattice point over the middle of the band at vertex `last` that is above all of the
/// curve between; nothing if it leaves the band.
std::optional<FittedMove> CurveFit::arc_to(LatticePoint p, std::size_t next, std::size_t last) const {
  const std::int64_t i = before(curve_[last].t);
  if (i <= p.i + 4) return std::nullopt;
  const CurvePoint from{t(p.i), z(p.k)};
  FittedMove arc{FittedMove::Kind::over, {i, above(highest(t(i), t(i), last) + options_.band / 2)}, {}};
  const CurvePoint to{t(i), z(arc.end.k)};
  const double chord = std::sqrt(squared_distance(from, to));
  const double ut = (to.t - from.t) / chord, uz = (to.z - from.z) / chord;
  double bend = -std::numeric_limits<double>::infinity();
  for (std::size_t v = next; v <= last; ++v) {
    const double dt = curve_[v].t - from.t, dz = curve_[v].z - from.z;
    const double x = dt * ut + dz * uz, y = dz * ut - dt * uz + options_.arc_lift;
    const double under = x * (chord - x) - y * y;
    if (under <= 0) {
      if (y > 0 && x > 0 && x < chord) return std::nullopt;  // needs more than half a circle
      continue;
    }
    bend = std::max(bend, 2 * y / under);
  }
  if (!std::isfinite(bend) || std::abs(bend) * chord * chord < 4 * options_.unit) return std::nullopt;
  if (1 / std::abs(bend) > options_.most_radius) return std::nullopt;
  const double y0 = -1 / bend, unit = options_.unit;
  const double ct = (from.t + to.t) / 2 - uz * y0, cz = (from.z + to.z) / 2 + ut * y0;
  arc.kind = bend > 0 ? FittedMove::Kind::over : FittedMove::Kind::under;
  arc.centre = {std::llround(ct / unit), std::llround((cz - options_.z0) / unit)};
  if (!arc_holds(p, arc, next, last)) return std::nullopt;
  return arc;
}

/// The arc as it will be written, between the lesser and the greater of its two radii, against the curve.
bool CurveFit::arc_holds(LatticePoint p, const FittedMove& arc, std::size_t next, std::size_t last) const {
  const double unit = options_.unit;
  const CurvePoint centre{double(arc.centre.i) * unit, z(arc.centre.k)};
  const CurvePoint from{t(p.i), z(p.k)}, to{t(arc.end.i), z(arc.end.k)};
  const double r0 = std::sqrt(squared_distance(from, centre)), r1 = std::sqrt(squared_distance(to, centre));
  const double least = std::min(r0, r1), most = std::max(r0, r1);
  if (most - least > 1.5 * unit || least <= std::max(8 * unit, options_.least_radius)) return false;
  const bool over = arc.kind == FittedMove::Kind::over;
  // An arc that turns back would pass over places that are not looked at.
  if (over ? std::min(from.z, to.z) < centre.z : std::max(from.z, to.z) > centre.z) return false;
  const auto on_curve = [&](double at, std::size_t hint) { return CurvePoint{at, highest(at, at, hint)}; };
  CurvePoint before_it = on_curve(from.t, next);
  for (std::size_t v = next; v <= last; ++v) {
    const CurvePoint p1 = curve_[v].t > to.t ? on_curve(to.t, v) : curve_[v];
    const double near = least_distance(before_it, p1, centre);
    const double far = std::sqrt(std::max(squared_distance(before_it, centre), squared_distance(p1, centre)));
    if (over ? far > least - options_.arc_lift + unit || near < most - options_.band - options_.arc_lift
             : near < most - unit || far > least + options_.band)
      return false;
    before_it = p1;
    if (curve_[v].t > to.t) break;
  }
  return true;
}

/// An arc that ends beyond `at_least`, as far as doubling and halving the number of vertices finds one.
std::optional<FittedMove> CurveFit::arc_from(LatticePoint p, std::size_t next, std::int64_t at_least) const {
  std::optional<FittedMove> best;
  std::size_t good = next, bad = curve_.size();
  const auto attempt = [&](std::size_t last) {
    const auto arc = arc_to(p, next, last);
    if (arc && (!best || arc->end.i > best->end.i)) best = arc;
    return arc.has_value();
  };
  // Short arcs may fail where longer ones do not: the first few are tried in any case.
  for (std::size_t length = 1; next + length < curve_.size(); length *= 2) {
    if (attempt(next + length))
      good = next + length;
    else if (length > 4) {
      bad = next + length;
      break;
    }
  }
  if (bad == curve_.size() && good + 1 < curve_.size()) {
    if (attempt(curve_.size() - 1)) good = curve_.size() - 1;
  }
  while (good + 1 < bad) {
    const std::size_t middle = good + (bad - good) / 2;
    (attempt(middle) ? good : bad) = middle;
  }
  if (!best || best->end.i <= at_least) return std::nullopt;
  return best;
}

}  // namespace krepl::mill
