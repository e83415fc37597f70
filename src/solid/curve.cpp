#include "solid/curve.hpp"

#include <Geom2dAPI_Interpolate.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_Line.hxx>
#include <GeomAPI_Interpolate.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_Circle.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Line.hxx>
#include <Geom_Plane.hxx>
#include <Geom_SphericalSurface.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_HArray1OfReal.hxx>
#include <TColgp_Array1OfPnt2d.hxx>
#include <TColgp_HArray1OfPnt.hxx>
#include <TColgp_HArray1OfPnt2d.hxx>
#include <algorithm>
#include <numbers>

namespace krepl::solid {

namespace {

constexpr double pi = std::numbers::pi;
constexpr int most_points = 2049;
/// More points are of no use when so often twice as many made it hardly better: the points themselves are no closer.
constexpr int most_stalled = 2;

gp_Dir direction(Point3 v) { return {v.x, v.y, v.z}; }

/// Angles at which a curve about `frame` begins and ends; `reversed` if it runs against them. Coordinates along x count
/// in units of `major`, along y of `minor`.
struct Turn {
  double first, last;
  bool reversed;
};
Turn turn_through(const Patch& frame, double major, double minor, const Course& course) {
  const auto angle = [&](Point3 p) {
    return std::atan2(dot(p - frame.at, frame.y) / minor, dot(p - frame.at, frame.x) / major);
  };
  const auto positive = [](double turned) { return turned < 0 ? turned + 2 * pi : turned; };
  const double start = angle(course.from), to_over = positive(angle(course.over) - start);
  if (course.closed) return to_over <= pi ? Turn{start, start + 2 * pi, false} : Turn{-start, -start + 2 * pi, true};
  const double to_end = positive(angle(course.to) - start);
  if (to_over <= to_end) return {start, start + to_end, false};
  return {-start, -start + (2 * pi - to_end), true};
}

void add_gap(Curve& curve, Point3 a, Point3 b) {
  curve.gap = std::max(distance(from_occ(curve.curve->Value(curve.first)), a),
                       distance(from_occ(curve.curve->Value(curve.last)), b));
}

Handle(TColStd_HArray1OfReal) real_array(const std::vector<double>& values) {
  Handle(TColStd_HArray1OfReal) array = new TColStd_HArray1OfReal(1, int(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) array->SetValue(int(i) + 1, values[i]);
  return array;
}

/// Derivative at the first of some points by the parabola or cubic through them.
template <class Vec>
Vec end_slope(const std::vector<double>& t, const std::vector<Vec>& p, bool at_end) {
  const std::size_t count = std::min<std::size_t>(t.size(), 5);
  const auto index = [&](std::size_t i) { return at_end ? t.size() - 1 - i : i; };
  Vec slope{};
  for (std::size_t i = 0; i < count; ++i) {
    // Derivative at t0 of Lagrange's polynomial of point i.
    double weight = 0;
    if (i == 0) {
      for (std::size_t k = 1; k < count; ++k) weight += 1 / (t[index(0)] - t[index(k)]);
    } else {
      weight = 1 / (t[index(i)] - t[index(0)]);
      for (std::size_t k = 1; k < count; ++k)
        if (k != i) weight *= (t[index(0)] - t[index(k)]) / (t[index(i)] - t[index(k)]);
    }
    slope += weight * p[index(i)];
  }
  return slope;
}

Handle(Geom_Curve) spline(const std::vector<Point3>& points, const std::vector<double>& knots) {
  Handle(TColgp_HArray1OfPnt) array = new TColgp_HArray1OfPnt(1, int(points.size()));
  std::vector<gp_Vec> vectors;
  for (std::size_t i = 0; i < points.size(); ++i) {
    array->SetValue(int(i) + 1, to_occ(points[i]));
    const Point3 d = points[i] - points[0];
    vectors.emplace_back(d.x, d.y, d.z);
  }
  GeomAPI_Interpolate interpolate(array, real_array(knots), false, 1e-300);
  interpolate.Load(end_slope(knots, vectors, false), end_slope(knots, vectors, true), false);
  interpolate.Perform();
  return Handle(Geom_Curve)(interpolate.Curve());
}

/// Points a curve does not stop at do not count twice.
void drop_repeated(std::vector<Point3>& points) {
  double whole = 0;
  for (std::size_t i = 1; i < points.size(); ++i) whole += distance(points[i - 1], points[i]);
  std::vector<Point3> kept{points.front()};
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (distance(kept.back(), points[i]) > 1e-9 * whole) kept.push_back(points[i]);
  }
  if (kept.size() > 1) kept.back() = points.back();
  points = std::move(kept);
}

std::vector<double> chord_lengths(const std::vector<Point3>& points) {
  std::vector<double> knots{0};
  for (std::size_t i = 1; i < points.size(); ++i) knots.push_back(knots.back() + distance(points[i - 1], points[i]));
  return knots;
}

/// So many equally spaced parameters of a curve, or its knots and as many between each two as makes up for it.
std::vector<double> parameters(const Curve& curve, int pieces) {
  std::vector<double> result;
  if (curve.knots.empty()) {
    for (int i = 0; i <= pieces; ++i) result.push_back(curve.first + (curve.last - curve.first) * i / pieces);
    return result;
  }
  const int each = std::max(1, pieces / int(curve.knots.size() - 1));
  for (std::size_t i = 1; i < curve.knots.size(); ++i) {
    for (int k = 0; k < each; ++k)
      result.push_back(curve.knots[i - 1] + (curve.knots[i] - curve.knots[i - 1]) * k / each);
  }
  result.push_back(curve.knots.back());
  return result;
}

Handle(Geom2d_Curve) spline(const std::vector<Point>& places, const std::vector<double>& knots) {
  Handle(TColgp_HArray1OfPnt2d) array = new TColgp_HArray1OfPnt2d(1, int(places.size()));
  std::vector<gp_Vec2d> vectors;
  for (std::size_t i = 0; i < places.size(); ++i) {
    array->SetValue(int(i) + 1, gp_Pnt2d(places[i].x, places[i].y));
    vectors.emplace_back(places[i].x - places[0].x, places[i].y - places[0].y);
  }
  Geom2dAPI_Interpolate interpolate(array, real_array(knots), false, 1e-300);
  interpolate.Load(end_slope(knots, vectors, false), end_slope(knots, vectors, true), false);
  interpolate.Perform();
  return Handle(Geom2d_Curve)(interpolate.Curve());
}

Handle(Geom2d_Curve) straight(Point a, Point b, const Curve& curve) {
  const double dx = b.x - a.x, dy = b.y - a.y, span = curve.last - curve.first, speed = std::hypot(dx, dy) / span;
  if (std::fabs(speed - 1) < 1e-9) {
    const gp_Dir2d along(dx, dy);
    return new Geom2d_Line(gp_Pnt2d(a.x - along.X() * curve.first, a.y - along.Y() * curve.first), along);
  }
  TColgp_Array1OfPnt2d poles(1, 2);
  poles.SetValue(1, gp_Pnt2d(a.x, a.y));
  poles.SetValue(2, gp_Pnt2d(b.x, b.y));
  TColStd_Array1OfReal knots(1, 2);
  knots.SetValue(1, curve.first);
  knots.SetValue(2, curve.last);
  TColStd_Array1OfInteger multiplicities(1, 2);
  multiplicities.Init(2);
  return new Geom2d_BSplineCurve(poles, knots, multiplicities, 1);
}

/// Splines stray between the parameters they were made from, most in the first and last stretch.
constexpr double between[] = {0, 0.2, 0.4, 0.6, 0.8};

/// The largest distance between the curve in space and the one on the surface.
double distance_between(const Patch& patch, const Curve& curve, const Handle(Geom2d_Curve) & trace,
                        const std::vector<double>& at) {
  double largest = 0;
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    for (const double part : between) {
      const double t = at[i] + part * (at[i + 1] - at[i]);
      const gp_Pnt2d place = trace->Value(t);
      largest = std::max(largest, distance(patch.point({place.X(), place.Y()}), from_occ(curve.curve->Value(t))));
    }
  }
  return largest;
}

}  // namespace

gp_Pnt to_occ(Point3 p) { return {p.x, p.y, p.z}; }
Point3 from_occ(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }

Handle(Geom_Surface) to_occ(const Patch& patch) {
  const gp_Ax3 frame(to_occ(patch.at), direction(patch.z), direction(patch.x));
  if (patch.kind == Patch::Kind::plane) return new Geom_Plane(frame);
  if (patch.kind == Patch::Kind::cylinder) return new Geom_CylindricalSurface(frame, patch.radius);
  return new Geom_SphericalSurface(frame, patch.radius);
}

Curve line_between(Point3 a, Point3 b) {
  return {new Geom_Line(to_occ(a), direction(b - a)), 0, distance(a, b), {}, 0};
}

Curve circle_through(Point3 centre, Point3 axis, double radius, const Course& course) {
  Patch frame;
  frame.at = centre;
  frame.z = unit(axis);
  frame.x = unit(course.from - centre - dot(course.from - centre, frame.z) * frame.z);
  frame.y = cross(frame.z, frame.x);
  const Turn turn = turn_through(frame, 1, 1, course);
  const gp_Ax2 axes(to_occ(centre), direction(turn.reversed ? -1.0 * frame.z : frame.z), direction(frame.x));
  Curve curve{new Geom_Circle(axes, radius), turn.first, turn.last, {}, 0};
  add_gap(curve, course.from, course.to);
  return curve;
}

std::optional<Curve> ellipse_through(Point3 on_plane, Point3 normal, const Patch& cylinder, const Course& course) {
  constexpr double flattest = 1e-3;  // thinner ellipses are fitted: their axes would be known too badly
  const double slope = dot(normal, cylinder.z);
  if (std::fabs(slope) < flattest) return std::nullopt;
  Patch frame;
  frame.at = cylinder.at + (dot(on_plane - cylinder.at, normal) / slope) * cylinder.z;
  const Point3 along = cylinder.z - slope * normal;
  if (length(along) < flattest) return circle_through(frame.at, cylinder.z, cylinder.radius, course);
  frame.x = unit(along);
  frame.z = normal;
  frame.y = cross(frame.z, frame.x);
  const double minor = cylinder.radius, major = minor / std::fabs(slope);
  const Turn turn = turn_through(frame, major, minor, course);
  const gp_Ax2 axes(to_occ(frame.at), direction(turn.reversed ? -1.0 * frame.z : frame.z), direction(frame.x));
  Curve curve{new Geom_Ellipse(axes, major, minor), turn.first, turn.last, {}, 0};
  add_gap(curve, course.from, course.to);
  return curve;
}

Curve fit(const std::function<std::vector<Point3>(int)>& points, const Patch& one, const Patch& other,
          double tolerance) {
  Curve best;
  double best_deviation = HUGE_VAL;
  int stalled = 0;
  for (int count = 9; count <= most_points && stalled < most_stalled; count = 2 * count - 1) {
    std::vector<Point3> through = points(count);
    drop_repeated(through);
    if (through.size() < 3) return line_between(through.front(), through.back());
    Curve curve;
    curve.knots = chord_lengths(through);
    curve.curve = spline(through, curve.knots);
    curve.last = curve.knots.back();
    const double found = std::max(deviation(one, curve), deviation(other, curve));
    stalled = found > best_deviation / 2 ? stalled + 1 : 0;
    if (found < best_deviation) best = curve, best_deviation = found;
    if (found <= tolerance) break;
  }
  return best;
}

double deviation(const Patch& patch, const Curve& curve) {
  const std::vector<double> at = parameters(curve, 8);
  double largest = 0;
  for (std::size_t i = 0; i + 1 < at.size(); ++i)
    for (const double part : between)
      largest = std::max(largest, patch.distance(from_occ(curve.curve->Value(at[i] + part * (at[i + 1] - at[i])))));
  return largest;
}

Trace trace_on(const Patch& patch, const Curve& curve, double tolerance) {
  Trace best;
  best.deviation = HUGE_VAL;
  int stalled = 0;
  for (int pieces = 4; pieces < most_points && stalled < most_stalled; pieces *= 2) {
    const std::vector<double> at = parameters(curve, pieces);
    std::vector<Point> places;
    for (const double t : at) places.push_back(patch.parameters(from_occ(curve.curve->Value(t))));
    if (pieces == 4) {
      best.curve = straight(places.front(), places.back(), curve);
      best.deviation = distance_between(patch, curve, best.curve, at);
      if (best.deviation <= tolerance) return best;
    }
    const Handle(Geom2d_Curve) trace = spline(places, at);
    const double found = distance_between(patch, curve, trace, at);
    stalled = pieces > 4 && found > best.deviation / 2 ? stalled + 1 : 0;
    if (found < best.deviation) best = {trace, found};
    if (found <= tolerance) break;
  }
  return best;
}

}  // namespace krepl::solid
