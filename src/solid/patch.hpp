#pragma once

#include <optional>
#include <span>

#include "kernel/vectors.hpp"
#include "krepl/surface.hpp"

namespace krepl::solid {

using namespace vectors;

/// The whole plane, cylinder or sphere of which a face is a piece, in an orthonormal frame: its outward normal is that
/// of the solid. Parameters are those of STEP and OpenCASCADE: a plane's are x and y; a cylinder's the angle about z,
/// in [0, 2 pi), and z; a sphere's longitude in [0, 2 pi) and latitude. Frames are turned so that no face reaches the
/// line where the angle starts anew, or a pole: edges there would have to be cut, and readers disagree about how.
struct Patch {
  enum class Kind { plane, cylinder, sphere };
  Kind kind = Kind::plane;
  Point3 at{};  ///< a point of the plane or axis, or the centre
  Point3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  double radius = 0;

  Point parameters(Point3 p) const;
  Point3 point(Point parameters) const;
  double distance(Point3 p) const;  ///< from p to the whole surface
};

/// The patch on which the ball's centre lies while it touches a feature; for spheres see turned_away().
Patch patch_of(const Terrain& terrain, Terrain::Index feature, double radius);

/// A sphere turned so that poles and the start of longitudes are away from a face with these points of its border;
/// nothing if there is no such place: the face is all but a hemisphere.
std::optional<Patch> turned_away(const Patch& sphere, std::span<const Point3> border);

/// Height of a feature's patch over the place of p; that of p beyond its silhouette.
double height_over(const Surface& surface, Surface::Index feature, Point3 p);

/// The vertical plane through a line from a to b, or the vertical cylinder about a point; the solid on the left of a to
/// b.
Patch wall_plane(Point3 a, Point3 b);
Patch wall_cylinder(Point3 centre, double radius, Point3 middle);

}  // namespace krepl::solid
