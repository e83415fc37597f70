#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>

#include "krepl/drop_cutter.hpp"
#include "krepl/section.hpp"
#include "support/small_terrain.hpp"

namespace krepl::test {

using Random = std::mt19937_64;

double uniform(Random& random, double low, double high);

/// A surface to cut, and the drop cutter of the same terrain and ball to check against: it knows nothing of the
/// subdivision.
struct CutCase {
  std::string name;
  std::shared_ptr<const Terrain> terrain;
  std::shared_ptr<const Surface> surface;
  std::optional<DropCutter> cutter;
  std::optional<SurfaceCutter> cuts;
  std::vector<SmallTerrain::Triangle> triangles;  ///< relative to the terrain's origin; of small terrains only

  double scale() const { return std::max(surface->radius(), terrain->extent()); }
  /// -infinity where the ball touches nothing.
  double height(Point p) const { return cutter->at(p).height; }
  /// True if the surface, or a wall below a rim, passes the point that near. A gap between two walls is found however
  /// narrow it is, if it does not end at once.
  bool passes(Point3 p, double within) const;
  /// False if an edge of the surface is off: faults of the surface's engine are for its own tests (docs/status.md).
  bool is_sound() const;
  /// True for a point beside a vertex of the surface where walls are tangent: along them that is known to the root of
  /// the tolerance only (docs/surface.md), so nothing passes it nearer.
  bool is_at_tangent_walls(Point3 p, double within) const;
};

std::optional<CutCase> make_case(std::shared_ptr<const Terrain> terrain, double radius, std::string name);
std::optional<CutCase> make_case(const SmallTerrain& terrain);
std::shared_ptr<const Terrain> grid_of(std::size_t columns, std::size_t rows,
                                       const std::function<double(std::size_t, std::size_t)>& height);
/// Random small terrains of all families, and a radius.
SmallTerrain random_small_terrain(Random& random, int number);

/// What is wrong with a contour, or nothing: rings close, the surface passes through their points at the level, places
/// on a grid are inside if the surface is as high as the level there, nesting agrees with a count of rings around.
std::optional<std::string> fault_of(const CutCase& c, const Contour& contour, int grid);
/// What is wrong with a section, or nothing: points are on the surface, chains connect, and where there is a surface
/// there is a piece.
std::optional<std::string> fault_of(const CutCase& c, const Section& section, int places);

}  // namespace krepl::test
