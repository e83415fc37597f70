#include "differential/cgal_stadiums.hpp"

#include <CGAL/Boolean_set_operations_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Gps_circle_segment_traits_2.h>
#include <CGAL/Polygon_2.h>
#include <CGAL/approximated_offset_2.h>

#include <cmath>
#include <iterator>
#include <list>

namespace krepl::test {

namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Number = Kernel::FT;
using Traits = CGAL::Gps_circle_segment_traits_2<Kernel>;
using Set = CGAL::General_polygon_set_2<Traits>;
using Polygon = Traits::General_polygon_2;
using PolygonWithHoles = Traits::General_polygon_with_holes_2;
using Curve = Traits::Curve_2;
using Piece = Traits::X_monotone_curve_2;
using Place = Kernel::Point_2;

void append(const Curve& curve, Polygon& polygon) {
  const Traits traits;
  std::vector<CGAL::Object> parts;
  traits.make_x_monotone_2_object()(curve, std::back_inserter(parts));
  for (const CGAL::Object& part : parts) {
    Piece piece;
    if (CGAL::assign(piece, part)) polygon.push_back(piece);
  }
}

Polygon stadium(const ExactSegment& s, const Number& r) {
  Polygon polygon;
  const Place a(s.ax, s.ay), b(s.bx, s.by);
  const Kernel::Circle_2 about_a(a, r * r, CGAL::COUNTERCLOCKWISE), about_b(b, r * r, CGAL::COUNTERCLOCKWISE);
  if (s.length == 0) {
    append(Curve(about_a), polygon);
    return polygon;
  }
  // Unit direction and left normal are rational.
  const Number ux = Number(s.bx - s.ax) / Number(s.length), uy = Number(s.by - s.ay) / Number(s.length);
  const auto off = [&](const Place& p, int side) {
    return Place(p.x() - Number(side) * r * uy, p.y() + Number(side) * r * ux);
  };
  using End = Traits::Point_2;
  const auto end = [](const Place& p) { return End(p.x(), p.y()); };
  const Place ar = off(a, -1), br = off(b, -1), bl = off(b, 1), al = off(a, 1);
  append(Curve(ar, br), polygon);
  append(Curve(about_b, end(br), end(bl)), polygon);
  append(Curve(bl, al), polygon);
  append(Curve(about_a, end(al), end(ar)), polygon);
  return polygon;
}

double area_of(const Polygon& polygon) {
  double twice = 0;
  double ox = 0, oy = 0;
  bool first = true;
  for (auto it = polygon.curves_begin(); it != polygon.curves_end(); ++it) {
    const double px = CGAL::to_double(it->source().x()), py = CGAL::to_double(it->source().y());
    const double qx = CGAL::to_double(it->target().x()), qy = CGAL::to_double(it->target().y());
    if (first) ox = px, oy = py, first = false;
    twice += (px - ox) * (qy - oy) - (py - oy) * (qx - ox);
    if (!it->is_circular()) continue;
    // An x-monotone arc spans at most half a circle.
    const double r = std::sqrt(CGAL::to_double(it->supporting_circle().squared_radius()));
    const double half_chord = std::min(1.0, std::hypot(qx - px, qy - py) / (2 * r));
    const double angle = 2 * std::asin(half_chord);
    const double excess = r * r * (angle - std::sin(angle));
    twice += it->orientation() == CGAL::COUNTERCLOCKWISE ? excess : -excess;
  }
  return std::abs(twice / 2);
}

ExactZone summary(const std::list<PolygonWithHoles>& polygons) {
  ExactZone zone;
  for (const PolygonWithHoles& p : polygons) {
    ++zone.polygons;
    zone.area += area_of(p.outer_boundary());
    for (auto h = p.holes_begin(); h != p.holes_end(); ++h) ++zone.holes, zone.area -= area_of(*h);
  }
  return zone;
}

}  // namespace

ExactZone exact_zone(const std::vector<ExactSegment>& segments, long numerator, long denominator) {
  const Number r = Number(numerator) / Number(denominator);
  std::vector<Polygon> stadiums;
  for (const ExactSegment& s : segments) stadiums.push_back(stadium(s, r));
  Set set;
  set.join(stadiums.begin(), stadiums.end());
  std::list<PolygonWithHoles> polygons;
  set.polygons_with_holes(std::back_inserter(polygons));
  return summary(polygons);
}

ExactZone approximate_offset(const std::vector<Point>& polygon, double radius, double error) {
  CGAL::Polygon_2<Kernel> p;
  for (const Point& v : polygon) p.push_back(Place(v.x, v.y));
  const auto offset = CGAL::approximated_offset_2(p, Number(radius), error);
  ExactZone zone;
  zone.polygons = 1;
  zone.area = area_of(offset.outer_boundary());
  for (auto h = offset.holes_begin(); h != offset.holes_end(); ++h) ++zone.holes, zone.area -= area_of(*h);
  return zone;
}

}  // namespace krepl::test
