#pragma once

#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>
#include <functional>
#include <optional>
#include <vector>

#include "solid/patch.hpp"

namespace krepl::solid {

/// A piece of a curve in space as an edge has it.
struct Curve {
  Handle(Geom_Curve) curve;
  double first = 0, last = 0;
  std::vector<double> knots;  ///< of fitted curves: their parameters; others are smooth
  double gap = 0;             ///< largest distance between an end and the corner it belongs to
};

gp_Pnt to_occ(Point3 p);
Point3 from_occ(const gp_Pnt& p);
Handle(Geom_Surface) to_occ(const Patch& patch);

/// The straight piece between two points.
Curve line_between(Point3 a, Point3 b);
/// Where an edge begins and ends, and a place between; of a closed edge, which is a whole turn, in its first half.
struct Course {
  Point3 from, over, to;
  bool closed;
};
/// The arc about a centre.
Curve circle_through(Point3 centre, Point3 axis, double radius, const Course& course);
/// The piece of the plane's section with a cylinder; nothing if they meet at too flat an angle.
std::optional<Curve> ellipse_through(Point3 on_plane, Point3 normal, const Patch& cylinder, const Course& course);
/// A cubic spline through points of a true curve, more and more of them until it is within `tolerance` of both surfaces
/// everywhere. `points(n)` gives about n of them, ends included.
Curve fit(const std::function<std::vector<Point3>(int)>& points, const Patch& one, const Patch& other,
          double tolerance);

/// The curve in the parameters of a surface that is no plane, at the same parameter as in space, and how far it then is
/// from it.
struct Trace {
  Handle(Geom2d_Curve) curve;
  double deviation = 0;
};
Trace trace_on(const Patch& patch, const Curve& curve, double tolerance);
/// The largest distance of an edge's points from a surface.
double deviation(const Patch& patch, const Curve& curve);

/// The true curve of a surface's edge along half-edge 2e between its corners, which lies on two patches; where it is
/// not known as a circle or ellipse to within the tolerance, it is fitted.
Curve edge_curve(const Surface& surface, Surface::Index e, Point3 from, Point3 to, bool closed, const Patch& one,
                 const Patch& other, double tolerance);

}  // namespace krepl::solid
