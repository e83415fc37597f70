#pragma once

#include <span>
#include <vector>

#include "krepl/terrain.hpp"
#include "support/small_terrain.hpp"

namespace krepl::test {

using Long = long double;

struct LongPoint {
  Long x, y, z;
};

/// The nearest place of a point, segment or triangle, and how far away it is.
struct Nearest {
  LongPoint at;
  Long distance;
};
Nearest nearest_on(const Terrain::Corners& feature, LongPoint p);

/// A ball above a set of triangles by formulas for a single triangle, in extended precision and without any structure:
/// what the engine must agree with.
class BallOracle {
 public:
  /// Triangles are moved by -origin first.
  BallOracle(std::span<const SmallTerrain::Triangle> triangles, Point3 origin, double radius);

  /// Height of the centre of the highest ball over a place that touches one of the triangles; minus infinity if none
  /// does.
  Long height(Point p) const;
  /// Distance of the nearest triangle.
  Long distance(LongPoint p) const;
  /// Height of the ball over p that touches this feature in its inside; minus infinity if none does.
  Long height(const Terrain::Corners& feature, Point p) const;

 private:
  static Long beside(const Terrain::Corners& f, Long x, Long y);

  Long radius_;
  std::vector<Terrain::Corners> triangles_;
  /// Vertices, edges and faces, one for each triangle that has it.
  std::vector<Terrain::Corners> features_;
};

}  // namespace krepl::test
