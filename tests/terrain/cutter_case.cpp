#include "cutter_case.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "kernel/quad.hpp"

namespace krepl::test {

namespace {

using kernel::quad;

long double root(long double x) { return x > 0 ? std::sqrt(x) : 0; }
quad root(quad x) { return kernel::square_root(x); }

/// The profile from the cutter's kind and numbers, in words of geometry: a circle's lower side, a line.
template <class Real>
Real profile(const Cutter& cutter, Real r) {
  const Real radius = Real(cutter.diameter()) / 2, corner = cutter.corner_radius();
  const Real slope = cutter.angle() > 0 ? Real(cutter.slope()) : Real(0);
  const auto circle = [&](Real out) { return out > 0 ? corner - root(corner * corner - out * out) : Real(0); };
  switch (cutter.kind()) {
    case Cutter::Kind::ball:
      return circle(r);
    case Cutter::Kind::flat:
      return 0;
    case Cutter::Kind::bull_nose:
      return circle(r - (radius - corner));
    case Cutter::Kind::cone:
      return slope * r;
    case Cutter::Kind::taper: {
      // The flank is the line of this slope at distance `corner` below the tip's centre: z = slope r - corner
      // (hypotenuse - 1).
      const Real hypotenuse = root(1 + slope * slope);
      const Real touches = corner * slope / hypotenuse;
      return r <= touches ? circle(r) : slope * r - corner * (hypotenuse - 1);
    }
  }
  return 0;
}

/// The greatest value of a concave function over an interval.
template <class Real, class Function>
Real greatest(Real low, Real high, const Function& f) {
  const Real golden = (root(Real(5)) - 1) / 2;
  Real a = high - golden * (high - low), b = low + golden * (high - low), fa = f(a), fb = f(b);
  Real best = std::max({fa, fb, f(low), f(high)});
  for (int step = 0; step < 170 && a < b; ++step) {
    if (fa < fb) {
      low = a, a = b, fa = fb, b = low + golden * (high - low), fb = f(b);
      best = std::max(best, fb);
    } else {
      high = b, b = a, fb = fa, a = high - golden * (high - low), fa = f(a);
      best = std::max(best, fa);
    }
  }
  return best;
}

template <class Real>
struct Search {
  const Cutter& cutter;
  Real x, y, radius;
  Real reach;  // of what counts as touched: R but for what rounding may decide
  std::optional<Real> best{};

  void offer(Real z) {
    if (!best || z > *best) best = z;
  }
  void corner(Point3 v) {
    const Real dx = v.x - x, dy = v.y - y, squared = dx * dx + dy * dy;
    if (squared <= reach * reach) offer(v.z - profile(cutter, std::min(root(squared), radius)));
  }
  void side(Point3 a, Point3 b) {
    const Real dx = Real(b.x) - a.x, dy = Real(b.y) - a.y, dz = Real(b.z) - a.z, length = dx * dx + dy * dy;
    if (!(length > 0)) return;
    const Real cross = dx * (y - a.y) - dy * (x - a.x), foot = (dx * (x - a.x) + dy * (y - a.y)) / length;
    const Real h = cross * cross / length, half = root((reach * reach - h) / length);
    if (h > reach * reach) return;
    const Real low = std::max(Real(0), foot - half), high = std::min(Real(1), foot + half);
    if (!(low <= high)) return;
    offer(greatest<Real>(low, high, [&](Real t) {
      const Real off = (t - foot) * (t - foot) * length;
      return a.z + t * dz - profile(cutter, std::min(root(h + off), radius));
    }));
  }
  void face(const std::array<Point3, 3>& t) {
    const Real ux = Real(t[1].x) - t[0].x, uy = Real(t[1].y) - t[0].y, uz = Real(t[1].z) - t[0].z;
    const Real vx = Real(t[2].x) - t[0].x, vy = Real(t[2].y) - t[0].y, vz = Real(t[2].z) - t[0].z;
    const Real area = ux * vy - uy * vx;
    if (area == 0) return;
    const Real gx = (uz * vy - uy * vz) / area, gy = (ux * vz - uz * vx) / area, slope = root(gx * gx + gy * gy);
    const auto inside = [&](Real r) {  // straight uphill
      const Real ex = x - t[0].x + (slope > 0 ? gx / slope * r : Real(0)),
                 ey = y - t[0].y + (slope > 0 ? gy / slope * r : Real(0));
      const Real v = (ex * vy - ey * vx) / area, w = (ux * ey - uy * ex) / area;
      return v >= 0 && w >= 0 && v + w <= 1;
    };
    // The concave function over the line uphill; where its greatest value over the part inside lies does not matter:
    // that part holds points of the triangle, and the greatest of all, if it is inside, is among them.
    const Real level = t[0].z + gx * (x - t[0].x) + gy * (y - t[0].y);
    const auto value = [&](Real r) { return inside(r) ? level + slope * r - profile(cutter, r) : Real(-1e300); };
    Real low = 0, high = std::min(radius, reach);
    const auto g = [&](Real r) { return level + slope * r - profile(cutter, r); };
    const Real golden = (root(Real(5)) - 1) / 2;
    for (const Real end : {low, high})
      if (inside(end)) offer(value(end));
    for (int step = 0; step < 170; ++step) {
      const Real a = high - golden * (high - low), b = low + golden * (high - low);
      if (!(a < b)) break;
      if (inside(a)) offer(value(a));
      if (inside(b)) offer(value(b));
      if (g(a) < g(b))
        low = a;
      else
        high = b;
    }
  }
};

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

template <class Real>
std::optional<double> tip(const DropCase& c, Point place, const Cutter& cutter, double more = 0) {
  const Real whole = Real(cutter.diameter()) / 2;
  Search<Real> search{cutter, place.x, place.y, whole, whole + more};
  const double radius = cutter.radius() + std::abs(more);
  for (const auto& t : c.triangles) {
    if (std::max({t[0].x, t[1].x, t[2].x}) < place.x - radius ||
        std::min({t[0].x, t[1].x, t[2].x}) > place.x + radius ||
        std::max({t[0].y, t[1].y, t[2].y}) < place.y - radius ||
        std::min({t[0].y, t[1].y, t[2].y}) > place.y + radius) {
      continue;
    }
    search.face(t);
    for (std::size_t i = 0; i < 3; ++i) search.corner(t[i]), search.side(t[i], t[(i + 1) % 3]);
  }
  if (!search.best) return std::nullopt;
  return double(*search.best);
}

double distance(Point3 a, Point3 b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z); }

/// Distance of a point from the triangle, side or corner of a feature: that of the nearest point by its weights.
double distance_to(Point3 p, const Terrain::Corners& c) {
  if (c.count == 1) return distance(p, c.point[0]);
  const auto minus = [](Point3 a, Point3 b) { return Point3{a.x - b.x, a.y - b.y, a.z - b.z}; };
  const auto dot = [](Point3 a, Point3 b) {
    return double((long double)a.x * b.x + (long double)a.y * b.y + (long double)a.z * b.z);
  };
  const Point3 u = minus(c.point[1], c.point[0]), e = minus(p, c.point[0]);
  if (c.count == 2) {
    const double s = std::clamp(dot(u, e) / dot(u, u), 0.0, 1.0);
    return distance(e, {s * u.x, s * u.y, s * u.z});
  }
  const Point3 v = minus(c.point[2], c.point[0]);
  const Point3 n{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  return std::abs(dot(n, e)) / std::sqrt(dot(n, n));  // the touched point of a face is given by weights within it
}

}  // namespace

long double TestTool::height(long double r) const { return profile<long double>(cutter, r); }

TestTool any_tool(Random& random, double radius) {
  const double angle = random() % 3 == 0   ? 90
                       : random() % 2 == 0 ? uniform(random, 1, 179)
                                           : 30.0 * double(1 + random() % 5);
  switch (random() % 4) {
    case 0:
      return {*Cutter::flat(2 * radius)};
    case 1: {
      const double corner = random() % 4 == 0   ? radius
                            : random() % 3 == 0 ? radius / 2
                                                : radius * exponential(random, -6, 0);
      return {*Cutter::bull_nose(2 * radius, std::min(corner, radius))};
    }
    case 2:
      return {*Cutter::cone(2 * radius, angle)};
    default:
      return {*Cutter::taper(2 * radius, angle, radius * (random() % 2 == 0 ? 0.25 : exponential(random, -4, -0.01)))};
  }
}

std::optional<double> brute_tip(const DropCase& c, Point place, const Cutter& cutter, bool exactly) {
  return exactly ? tip<quad>(c, place, cutter) : tip<long double>(c, place, cutter);
}

std::optional<std::string> cutter_fault(const DropCase& c, Point place, const Cutter& cutter,
                                        const DropCutter::Contact& contact) {
  const double tolerance = 1e-12 * c.scale(cutter.radius());
  const std::string where = " at " + number(place.x) + ", " + number(place.y) + " with " + cutter.text();
  const auto right = [&](const std::optional<double>& height) {
    return height.has_value() == contact.touches() && (!height || std::abs(*height - contact.height) <= tolerance);
  };
  if (!right(brute_tip(c, place, cutter, false))) {
    const std::optional<double> height = brute_tip(c, place, cutter, true);
    // Heights jump where the rim passes over a corner. What is at distance R to within 2^-50 S may count or not.
    const auto with = [&](double more) {
      return tip<quad>(c, place, cutter, more).value_or(-std::numeric_limits<double>::infinity());
    };
    const double rim = 0x1p-50 * c.scale(cutter.radius());
    if (!right(height) && !(contact.height >= with(-rim) - tolerance && contact.height <= with(rim) + tolerance))
      return "height " + number(contact.height) + " in place of " + (height ? number(*height) : "none") + ", " +
             number(with(-rim)) + " to " + number(with(rim)) + " about the rim," + where;
  }
  if (!contact.touches()) return std::nullopt;
  const Point3 p = contact.point;
  if (distance_to(p, c.terrain->corners(contact.feature)) > tolerance)
    return "the touched point is not on its feature" + where;
  const quad dx = quad(p.x) - place.x, dy = quad(p.y) - place.y, r = root(dx * dx + dy * dy);
  const quad radius = quad(cutter.diameter()) / 2, up = quad(p.z) - contact.height, slack = 2 * quad(tolerance);
  if (r > radius + slack) return "the touched point is beyond the tool" + where;
  const quad inner = r > slack ? r - slack : quad(0), outer = r + slack;
  if (up < profile(cutter, std::min(inner, radius)) - slack) return "the touched point is below the tool" + where;
  if (outer < radius && up > profile(cutter, outer) + slack) return "the touched point is inside the tool" + where;
  return std::nullopt;
}

double deepest_sample(const DropCase& c, Point place, const Cutter& cutter, double tip, int samples, Random& random) {
  double deepest = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < samples; ++i) {
    const auto& t = c.triangles[random() % c.triangles.size()];
    double v = uniform(random, 0, 1), w = uniform(random, 0, 1);
    if (v + w > 1) v = 1 - v, w = 1 - w;
    const auto mix = [&](double a, double b, double d) { return a + v * (b - a) + w * (d - a); };
    const double x = mix(t[0].x, t[1].x, t[2].x) - place.x, y = mix(t[0].y, t[1].y, t[2].y) - place.y;
    const double r = std::hypot(x, y);
    if (r > cutter.radius()) continue;
    deepest = std::max(deepest, mix(t[0].z, t[1].z, t[2].z) - tip - double(profile<long double>(cutter, r)));
  }
  return deepest;
}

}  // namespace krepl::test
