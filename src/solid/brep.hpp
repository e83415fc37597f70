#pragma once

#include <TopoDS_Shape.hxx>
#include <cstddef>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/surface.hpp"

namespace krepl::solid {

struct BrepOptions {
  bool closed = false;         ///< walls at the outline and a floor below everything
  double tolerance = 0;        ///< edges shorter and faces narrower than this are left out
  double curve_tolerance = 0;  ///< how far fitted curves may be from the true ones
};

struct BrepCounts {
  std::size_t planes = 0, cylinders = 0, spheres = 0;  ///< faces of the surface, one for one
  std::size_t walls = 0, floors = 0;                   ///< faces added: vertical ones, and the floor's
  std::size_t narrow_faces = 0;                        ///< faces of the surface that are left out
  std::size_t edges = 0, shells = 0;
  double deviation =
      0;  ///< largest distance between an edge and the surfaces of its two faces, or a corner and its edges
};

struct Brep {
  TopoDS_Shape shape;  ///< a shell or solid, or a compound of several
  BrepCounts counts;
};

/// A surface as faces that share their edges and corners, one shell for each connected part; coordinates are those of
/// the input. Where the surface ends in a wall above a lower part, a vertical face closes the gap.
///
/// Errors: a face that is all but a hemisphere (named); cancelled; what OpenCASCADE reports. O(size of the surface);
/// some 10 KB a face.
Result<Brep> make_brep(const Surface& surface, const BrepOptions& options, const Context& context);

}  // namespace krepl::solid
