#pragma once

#include "krepl/point.hpp"
#include "krepl/terrain.hpp"

namespace krepl::output {

/// The plane, cylinder or sphere on which the ball's centre lies while it touches one feature of a terrain.
class SurfacePatch {
 public:
  SurfacePatch(const Terrain& terrain, Terrain::Index feature, double radius);
  SurfacePatch(Terrain::FeatureKind kind, const Terrain::Corners& corners, double radius);

  Terrain::FeatureKind kind() const { return kind_; }
  /// Height over a place; beyond the patch's silhouette, that of the silhouette.
  double height(double x, double y) const;
  /// Whether a ball about a point of the patch touches the feature itself, not the line or plane beyond its ends.
  bool is_over_feature(Point3 p) const;
  /// Unit normal, upwards, at a point of the patch.
  Point3 normal(Point3 p) const;

  /// Square of the part of a - b in which the patch is curved: none of a plane, across the axis of a cylinder, all of a
  /// sphere.
  double curved_square(Point3 a, Point3 b) const;
  /// How far the middle of a chord of that square lies below the patch.
  double sagitta(double curved_square) const;
  /// The largest distance between the patch and a triangle with its corners on it.
  double deviation(Point3 a, Point3 b, Point3 c) const;

 private:
  Terrain::FeatureKind kind_;
  double radius_;
  Terrain::Corners corners_;
  Point3 at_;         // a point of the feature
  Point3 direction_;  // face: unit normal; edge: unit direction
};

}  // namespace krepl::output
