#pragma once

#include <string>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/surface.hpp"

namespace krepl::solid {

struct StepOptions {
  bool closed = false;      ///< a solid: closed by walls at the outline and a floor
  std::string unit = "mm";  ///< of the coordinates: mm, cm, m, km, in, ft
  std::string name;         ///< of the product
  std::string date;         ///< of the file, as in ISO 8601
};

struct StepReport {
  std::size_t planes = 0, cylinders = 0, spheres = 0;  ///< faces of the surface
  std::size_t walls = 0, floors = 0;                   ///< faces that close it
  std::size_t narrow_faces = 0;                        ///< faces of the surface that are left out
  std::size_t edges = 0, shells = 0;
  double tolerance = 0;  ///< what is shorter or narrower is left out
  double deviation = 0;  ///< largest distance between an edge and the surfaces that it bounds
};

/// Writes a surface as a boundary representation (ISO 10303-21, AP214): faces on true planes, cylinders and spheres,
/// edges as lines, circles, ellipses or cubic splines, shared by their faces. What is smaller than half a millionth of
/// the radius is left out; if OpenCASCADE's checker rejects the result, which it does where an input in single
/// precision has edges hardly larger, ten times and a hundred times that is tried. The report tells. Errors: an unknown
/// unit (usage); what make_brep() says; a result that OpenCASCADE's checker rejects (computation, with the place); a
/// file that cannot be written.
Result<StepReport> write_step(const std::string& path, const Surface& surface, const StepOptions& options,
                              const Context& context);

}  // namespace krepl::solid
