#pragma once

#include "kernel/quad.hpp"
#include "krepl/cutter.hpp"
#include "terrain/drop_cutter_touch.hpp"

namespace krepl::drop {

/// The lower side of a cutter as a function of the distance from its axis: flat, corner, flank. Lengths are those of
/// the cutter, exactly; what follows from them is computed in Real.
template <class Real>
struct Profile {
  static constexpr double steepest_flank = 0x1p60;  // else it has none
  Real radius, flat, corner;
  bool flank;         // whether there is one
  Real slope;         // of the flank; 0 if there is none
  Real sine, cosine;  // of the angle at which the corner ends: 1 and 0 if there is no flank
  Real end;           // distance from the axis at which the corner ends
  Real end_height;

  Profile(Real radius_, Real flat_, Real corner_, double slope_);
  /// The flat is what a corner without a flank leaves; cutters with a flank have none.
  static Profile of(double radius, double corner, double slope) {
    return {radius, slope <= steepest_flank ? Real(0) : Real(radius) - corner, corner, slope};
  }

  /// Height above the tip. Precondition: 0 <= distance <= radius.
  Real height(Real distance) const {
    using kernel::square_root;
    if (distance <= flat) return 0;
    if (distance > end) return end_height + slope * (distance - end);
    const Real out = distance - flat;
    return out * out / (corner + square_root((corner - out) * (corner + out)));
  }
};

template <class Real>
Profile<Real>::Profile(Real radius_, Real flat_, Real corner_, double slope_)
    : radius(radius_), flat(flat_), corner(corner_), flank(slope_ <= steepest_flank), slope(flank ? slope_ : 0) {
  using kernel::square_root;
  const Real hypotenuse = square_root(1 + slope * slope);
  sine = flank ? slope / hypotenuse : Real(1), cosine = flank ? 1 / hypotenuse : Real(0);
  end = corner == 0 ? flat : flank ? flat + corner * sine : radius;
  end_height = corner * (1 - cosine);
}

struct ProfileBound;

/// A cutter that is no ball, on its way down over a place; heights are those of its tip.
struct ProfileTool {
  using Bound = ProfileBound;
  Point place;
  double radius;
  double squared;  // radius
  Profile<double> profile;
  double given_slope;  // of the cutter: infinity if it has no flank

  explicit ProfileTool(const Cutter& cutter)
      : place{},
        radius(cutter.radius()),
        squared(radius * radius),
        profile(Profile<double>::of(radius, cutter.corner_radius(), cutter.slope())),
        given_slope(cutter.slope()) {}
  double tip(double height) const { return height; }
};

/// As those of balls (drop_cutter_touch.hpp), by drop_cutter_profile.cpp. A touched point of a face or an edge is the
/// one nearest to the axis if the tool touches a stretch of it.
VertexTouch touch_vertex(Point3 v, const ProfileTool& tool);
EdgeTouch touch_edge(Point3 a, Point3 b, const ProfileTool& tool);
FaceTouch touch_face(Point3 a, Point3 b, Point3 c, const ProfileTool& tool);

}  // namespace krepl::drop
