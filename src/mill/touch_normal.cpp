#include "mill/touch_normal.hpp"

#include "kernel/vectors.hpp"

namespace krepl::mill {

using namespace vectors;

Point3 touch_normal(const Terrain& terrain, Terrain::Index feature, Point3 p) {
  const Terrain::Corners corners = terrain.corners(feature);
  const Point3 a = corners.point[0];
  Point3 normal = p - a;
  switch (terrain.feature_kind(feature)) {
    case Terrain::FeatureKind::vertex:
      break;
    case Terrain::FeatureKind::edge: {
      const Point3 d = corners.point[1] - a;
      normal = normal - (dot(normal, d) / dot(d, d)) * d;
      break;
    }
    case Terrain::FeatureKind::face:
      normal = cross(corners.point[1] - a, corners.point[2] - a);
      if (normal.z < 0) normal = -1.0 * normal;
      break;
  }
  const double size = length(normal);
  return size > 0 ? (1 / size) * normal : Point3{0, 0, 1};
}

}  // namespace krepl::mill
