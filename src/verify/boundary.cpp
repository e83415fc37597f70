#include "verify/boundary.hpp"

#include <algorithm>

namespace krepl::verify {

namespace {

constexpr Real pi = 3.141592653589793238462643383279502884L;

/// Centre of the circle through three points; false if they are (nearly) on a line.
bool circle_through(Vec a, Vec m, Vec b, Vec& centre) {
  const Vec u = m - a, v = b - a;
  const Real twice = 2 * cross(u, v);
  if (!(std::abs(twice) > 1e-30L * (dot(u, u) + dot(v, v)))) return false;
  const Real uu = dot(u, u), vv = dot(v, v);
  centre = a + Vec((v.y * uu - u.y * vv) / twice, (u.x * vv - v.x * uu) / twice);
  return true;
}

/// The signed angle from a over m to b about c. An arc so short that rounding hides the order of its three points is
/// taken as the short way round.
Real sweep_of(Vec a, Vec m, Vec b, Vec c, Real r) {
  const Vec u = a - c, v = b - c, w = m - c;
  const Real direct = std::atan2(cross(u, v), dot(u, v));  // the short way
  if (distance(a, b) < 1e-6L * r && distance(a, m) < 1e-6L * r) return direct;
  const auto forward = [](Real angle) { return angle < 0 ? angle + 2 * pi : angle; };
  const Real whole = forward(direct), middle = forward(std::atan2(cross(u, w), dot(u, w)));
  return middle <= whole ? whole : whole - 2 * pi;
}

}  // namespace

std::vector<Curve> Boundary::resolve(const std::vector<input::ResultPolygon>& polygons, const Obstacle& obstacle,
                                     const ArcPlaces& places, ArcFit& fit) {
  const Real radius = places.radius, tolerance = places.tolerance, inner = places.inner;
  std::vector<Curve> curves;
  std::uint32_t ring = 0;
  const auto& vertices = obstacle.vertices();

  const auto find_centre = [&](const Vec(&p)[3], Vec& centre, Real& own_radius) {
    Box around;
    around.add(p[1]);
    Real best = HUGE_VALL;
    vertices.for_each_in(around.grown(radius + tolerance), [&](std::uint32_t i) {
      const Vec v = vertices.items()[i].at;
      for (const Real offset : {radius, inner}) {
        Real worst = 0;
        const Real r = offset - vertices.items()[i].inset;
        for (const Vec& q : p) worst = std::max(worst, std::abs(distance(q, v) - r));
        if (r > 0 && worst < best) best = worst, centre = v, own_radius = r;
      }
    });
    return best;
  };

  /// The arc of the input that is concentric with these three places, as far from them all as it may be.
  const auto find_arc = [&](const Vec(&p)[3], std::optional<CircularArc>& bow) {
    Box around;
    around.add(p[1]);
    Real best = HUGE_VALL;
    const auto& segments = obstacle.segments();
    segments.for_each_in(around.grown(radius + tolerance), [&](std::uint32_t i) {
      const auto& own = segments.items()[i].arc;
      if (!own) return;
      const Real r = radius - segments.items()[i].inset;
      for (const Real side : {r, -r, inner, -inner, Real(0), r - 2 * own->r}) {
        if (side == 0 ? !places.along : side == r - 2 * own->r && !places.beyond) continue;
        Real worst = 0;
        for (const Vec& q : p) worst = std::max(worst, std::abs(own->off_circle(q) - side));
        if (worst >= best || own->r + side <= 0) continue;
        best = worst;
        bow = CircularArc::about(*own, p[0], p[1], p[2]);
      }
    });
    return best;
  };

  const auto add = [&](const input::ResultPiece& piece, bool outer) {
    Curve curve;
    curve.a = piece.start, curve.b = piece.end, curve.ring = ring;
    if (piece.arc) {
      ++fit.arcs;
      const Vec p[3] = {piece.start, piece.middle, piece.end};
      Vec circle;
      const bool round =
          piece.start == piece.end ? (circle = 0.5L * (p[0] + p[1]), true) : circle_through(p[0], p[1], p[2], circle);
      Vec centre;
      Real own_radius = radius;
      Real off = find_centre(p, centre, own_radius);
      std::optional<CircularArc> bow;
      const Real off_arc = obstacle.has_arcs() && off > 0 ? find_arc(p, bow) : HUGE_VALL;
      if (off_arc <= tolerance && off_arc < off) {
        off = off_arc;
        if (piece.start == piece.end) bow->left = outer;
        curve.bow = std::make_shared<const CircularArc>(*bow);
        curve.c = bow->a + bow->to_centre, curve.r = bow->r, curve.arc = true;
      } else if (off <= tolerance) {
        curve.c = centre, curve.r = own_radius, curve.arc = true;
      } else {
        ++fit.without_centre;
        curve.c = circle, curve.r = distance(circle, p[0]), curve.arc = round;
      }
      // Without any vertex near R the difference has no value; the count tells.
      if (off < HUGE_VALL && off > fit.worst) fit.worst = off, fit.where = p[1];
      if (curve.bow)
        curve.sweep = curve.bow->sweep();
      else if (curve.arc)
        curve.sweep =
            piece.start == piece.end ? (outer ? 2 * pi : -2 * pi) : sweep_of(p[0], p[1], p[2], curve.c, curve.r);
      // An arc whose ends coincide on a ray from the centre has no extent.
      if (curve.arc && curve.sweep == 0) curve.arc = false;
    }
    curves.push_back(curve);
  };

  for (const auto& polygon : polygons) {
    for (const auto& piece : polygon.outer.pieces) add(piece, true);
    ++ring;
    for (const auto& hole : polygon.holes) {
      for (const auto& piece : hole.pieces) add(piece, false);
      ++ring;
    }
  }
  return curves;
}

Boundary::Boundary(const std::vector<input::ResultPolygon>& polygons, const Obstacle& obstacle,
                   const ArcPlaces& places)
    : curves_(resolve(polygons, obstacle, places, arc_fit_)) {
  make_rings(polygons);
  make_parts();
}

void Boundary::make_rings(const std::vector<input::ResultPolygon>& polygons) {
  std::uint32_t first = 0, number = 0;
  const auto add = [&](const input::ResultRing& r, bool hole) {
    Ring ring{first, std::uint32_t(first + r.pieces.size()), number, hole, false};
    ring.turned = (ring_area(ring) < 0) != hole;
    first = ring.last;
    rings_.push_back(ring);
  };
  for (const auto& polygon : polygons) {
    add(polygon.outer, false);
    for (const auto& hole : polygon.holes) add(hole, true);
    ++number;
  }
}

Real Boundary::ring_area(const Ring& ring) const {
  const auto& curves = curves_.items();
  if (ring.first == ring.last) return 0;
  const Vec origin = curves[ring.first].a;
  Real twice = 0;
  for (std::uint32_t i = ring.first; i < ring.last; ++i) {
    const Curve& e = curves[i];
    twice += cross(e.a - origin, e.b - origin);
    if (!e.arc) continue;
    // The circular segment between arc and chord; the series keeps short arcs from cancelling.
    const Real s = e.sweep;
    const Real excess =
        std::abs(s) < 1e-3L ? s * s * s * (1 / 6.0L - s * s * (1 / 120.0L - s * s / 5040)) : s - std::sin(s);
    twice += e.r * e.r * excess;
  }
  return twice / 2;
}

Real Boundary::area() const {
  Real total = 0;
  for (const Ring& ring : rings_) total += (ring.hole ? -1 : 1) * std::abs(ring_area(ring));
  return total;
}

Real Boundary::perimeter() const {
  Real total = 0;
  for (const Curve& e : curves_.items()) total += e.length();
  return total;
}

void Boundary::make_parts() {
  std::vector<std::pair<Real, Real>> ranges;
  for (Curve e : curves_.items()) {
    if (e.bow) {
      add_parts_of(e.bow->in_ray_frame(), e.ring, ranges);
      continue;
    }
    e.a = ray_frame(e.a), e.b = ray_frame(e.b), e.c = ray_frame(e.c);
    // Cut arcs at the top and the bottom of their circle.
    std::vector<std::pair<Real, Vec>> cuts{{0, e.a}};
    if (e.arc) {
      const Vec u = e.a - e.c;
      const Real sense = e.sweep > 0 ? 1 : -1;
      for (const Vec pole : {Vec(0, e.r), Vec(0, -e.r)}) {
        Real angle = sense * std::atan2(cross(u, pole), dot(u, pole));
        if (angle < 0) angle += 2 * pi;
        if (angle > 0 && angle < std::abs(e.sweep)) cuts.emplace_back(angle, e.c + pole);
      }
      std::sort(cuts.begin(), cuts.end(), [](const auto& p, const auto& q) { return p.first < q.first; });
    }
    cuts.emplace_back(std::abs(e.sweep), e.b);
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      Part part{cuts[i].second, cuts[i + 1].second, 0, e.c, e.r, e.ring};
      if (e.arc) part.side = e.at((cuts[i].first + cuts[i + 1].first) / (2 * std::abs(e.sweep))).x > e.c.x ? 1 : -1;
      if (part.a.y == part.b.y) continue;
      ranges.push_back(std::minmax(part.a.y, part.b.y));
      parts_.push_back(part);
    }
  }
  bands_ = Bands(ranges);
}

void Boundary::add_parts_of(const CircularArc& arc, std::uint32_t ring, std::vector<std::pair<Real, Real>>& ranges) {
  const auto whole = std::make_shared<const CircularArc>(arc);
  // Cut at the top and the bottom of the circle; the fraction of the arc comes from the chord up to there, or the angle.
  std::vector<std::pair<Real, Vec>> cuts{{0, arc.a}, {1, arc.b}};
  for (const Real sign : {Real(1), Real(-1)}) {
    const Vec pole = arc.pole(sign);
    if (!arc.spans(arc.a + pole)) continue;
    const Real angle = arc.angle_to(arc.a + pole);
    const Real fraction = angle / std::abs(arc.sweep());
    if (fraction > 0 && fraction < 1) cuts.emplace_back(fraction, arc.a + pole);
  }
  std::sort(cuts.begin(), cuts.end(), [](const auto& p, const auto& q) { return p.first < q.first; });
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    Part part{cuts[i].second, cuts[i + 1].second, 0, {}, arc.r, ring, whole};
    const Vec inner = arc.at((cuts[i].first + cuts[i + 1].first) / 2) - arc.a;
    part.side = inner.x > arc.to_centre.x ? 1 : -1;
    if (part.a.y == part.b.y) continue;
    ranges.push_back(std::minmax(part.a.y, part.b.y));
    parts_.push_back(part);
  }
}

int Boundary::Part::crosses(Vec p) const {
  if ((a.y <= p.y) == (b.y <= p.y)) return 0;
  const int sense = b.y > a.y ? 1 : -1;
  if (side == 0) return sense * cross(b - a, p - a) > 0 ? sense : 0;
  const bool in_circle = bow ? bow->off_circle(p) < 0 : verify::distance(p, c) < r;
  const bool left_of_centre = bow ? p.x - bow->a.x < bow->to_centre.x : p.x < c.x;
  const bool left_of_part = side > 0 ? left_of_centre || in_circle : left_of_centre && !in_circle;
  return left_of_part ? sense : 0;
}

Real Boundary::Part::x_at(Real y) const {
  if (side == 0) return a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
  if (bow) {
    std::vector<Real> x;
    bow->crossings(y, 0, x);
    if (x.empty()) return a.x;
    return side > 0 ? std::max(x[0], x[1]) : std::min(x[0], x[1]);
  }
  const Real h = y - c.y;
  return c.x + side * std::sqrt(std::max(Real(0), (r - h) * (r + h)));
}

Real Boundary::section(Real y) const {
  std::vector<std::pair<Real, int>> crossings;
  for (const std::uint32_t i : bands_.at(y)) {
    const Part& part = parts_[i];
    if ((part.a.y <= y) == (part.b.y <= y)) continue;
    const bool down = (part.b.y < part.a.y) != rings_[part.ring].turned;
    crossings.emplace_back(part.x_at(y), down ? 1 : -1);
  }
  std::sort(crossings.begin(), crossings.end());
  Real total = 0;
  int depth = 0;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    depth += crossings[i].second;
    if (depth > 0) total += crossings[i + 1].first - crossings[i].first;
  }
  return total;
}

std::pair<Real, Real> Boundary::heights() const {
  Real low = HUGE_VALL, high = -HUGE_VALL;
  for (const Part& p : parts_)
    low = std::min(low, std::min(p.a.y, p.b.y)), high = std::max(high, std::max(p.a.y, p.b.y));
  return {low, high};
}

int Boundary::winding(Vec place) const {
  const Vec p = ray_frame(place);
  int total = 0;
  for (const std::uint32_t i : bands_.at(p.y)) {
    const int crossing = parts_[i].crosses(p);
    if (crossing != 0) total += rings_[parts_[i].ring].turned ? -crossing : crossing;
  }
  return total;
}

void Boundary::rings_around(Vec place, std::vector<std::uint32_t>& out) const {
  const Vec p = ray_frame(place);
  std::vector<std::pair<std::uint32_t, int>> found;
  for (const std::uint32_t i : bands_.at(p.y))
    if (const int crossing = parts_[i].crosses(p); crossing != 0) found.emplace_back(parts_[i].ring, crossing);
  std::sort(found.begin(), found.end());
  for (std::size_t i = 0; i < found.size();) {
    int total = 0;
    const std::uint32_t ring = found[i].first;
    for (; i < found.size() && found[i].first == ring; ++i) total += found[i].second;
    if (total != 0) out.push_back(ring);
  }
}

}  // namespace krepl::verify
