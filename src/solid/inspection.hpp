#pragma once

#include <TopoDS_Shape.hxx>
#include <array>
#include <optional>
#include <string>

#include "krepl/error.hpp"
#include "krepl/point.hpp"

namespace krepl::solid {

/// What OpenCASCADE finds in a shape.
struct Inspection {
  std::array<std::size_t, 4> faces{};  ///< on planes, cylinders, spheres, anything else
  double area = 0;
  std::optional<Point3> fault;  ///< near what its checker (BRepCheck_Analyzer) rejects; nothing if all is well
};

/// Where the checker rejects a shape, if it does.
std::optional<Point3> fault_of(const TopoDS_Shape& shape);
Inspection inspect(const TopoDS_Shape& shape);

/// Reads a STEP file; coordinates in the unit, one of those of unit_name(). Errors: what OpenCASCADE cannot read.
Result<TopoDS_Shape> read_step(const std::string& path, const std::string& unit);

/// OpenCASCADE's name of mm, cm, m, km, in or ft; null for anything else.
const char* unit_name(const std::string& unit);
/// OpenCASCADE says much on standard output; from now on it is silent.
void silence();

}  // namespace krepl::solid
