#pragma once

#include "krepl/cutter.hpp"
#include "verify/solid.hpp"

namespace krepl::verify {

/// How deep a part is in a cutter that is no ball, by searches over each triangle: shares nothing with the drop cutter
/// but the cutter's numbers.
class ToolDepth {
 public:
  ToolDepth(const Solid& solid, const Cutter& cutter);

  /// With the tip at a place relative to the solid's origin: the greatest distance of a point of the triangles from the
  /// outside of the tool, whose shank has no end; 0 if none is above the tool's lower side by more than `tolerance`.
  double at(Space<double> tip, double tolerance) const;

 private:
  double above(std::size_t triangle, Space<double> tip) const;
  double above_side(Space<double> a, Space<double> b, Space<double> tip) const;
  double above_face(const std::array<Space<double>, 3>& corner, Space<double> tip) const;
  double depth_of(Space<double> q) const;
  double depth_of_triangle(std::size_t triangle, Space<double> tip) const;

  const Solid& solid_;
  Cutter cutter_;
  double steepest_;  // angle of the lower side at the end of the corner
};

}  // namespace krepl::verify
