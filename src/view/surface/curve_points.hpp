#pragma once

#include <span>
#include <vector>

#include "input/subdivision_file.hpp"
#include "krepl/point.hpp"
#include "output/surface_patch.hpp"

namespace krepl::view {

/// The points of an edge, as few as keep its chords within `max_error` of the curve; both ends are the first and last
/// ones given, so that it joins its neighbours.
///
/// `given` are points of the curve in order, ends included: 2 or more. `between` are the two patches
/// of a valley, or null: what the file gives is then all that is known of an ellipse or quartic.
/// Circles are completed from three of their points.
std::vector<Point3> curve_points(std::span<const Point3> given, input::SubdivisionFile::Curve curve,
                                 const output::SurfacePatch* left, const output::SurfacePatch* right, double max_error);

}  // namespace krepl::view
