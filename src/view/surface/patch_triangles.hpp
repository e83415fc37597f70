#pragma once

#include <span>
#include <vector>

#include "krepl/point.hpp"
#include "output/polygon_triangulation.hpp"
#include "output/surface_patch.hpp"

namespace krepl::view {

/// Triangles of one face. The first points are those of its border, in the order given.
struct PatchTriangles {
  std::vector<Point3> points;
  std::vector<output::PolygonTriangulation::Triangle> triangles;
};

/// Triangles within `max_error` of the patch between loops of border points: the first one is the outer one,
/// counter-clockwise. Sides of the border stay as they are and should be within half of the deviation, or triangles
/// beside them are not within it.
///
/// Other than output::PatchMesh it puts new points where the patch is nearest, not straight above: upright parts of a
/// patch need few, and seen from above triangles may fold by as much as the deviation, which a picture does not show.
PatchTriangles patch_triangles(const output::SurfacePatch& patch, std::vector<Point3> points,
                               std::span<const std::vector<output::PolygonTriangulation::Index>> loops,
                               double max_error);

}  // namespace krepl::view
