#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "krepl/terrain.hpp"
#include "verify/box_hierarchy.hpp"
#include "verify/space.hpp"

namespace krepl::verify {

/// A feature by the numbers of its vertices in the solid, ascending; what is missing is none.
using FeatureKey = std::array<std::uint32_t, 3>;

/// The terrain and everything below it, as a set of triangles of its own. Coordinates are relative to origin().
class Solid {
 public:
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  explicit Solid(const Terrain& terrain);

  Point3 origin() const { return origin_; }
  /// Half the largest side of the bounding box.
  double half_extent() const;
  /// The distance of neighbouring doubles at the input's largest coordinate.
  double resolution() const { return resolution_; }
  const Box3& box() const { return tree_.box(); }
  std::size_t triangle_count() const { return triangles_.size(); }
  const std::array<std::uint32_t, 3>& triangle(std::size_t t) const { return triangles_[t]; }
  std::array<Space<double>, 3> corners(std::size_t t) const {
    return {corner(std::uint32_t(t), 0), corner(std::uint32_t(t), 1), corner(std::uint32_t(t), 2)};
  }
  const BoxHierarchy& tree() const { return tree_; }

  /// The feature with these points, relative to origin(); all none if a point is not a vertex of the input.
  FeatureKey key_of(const Shape& shape) const;
  Shape shape_of(const FeatureKey& key) const;

  /// A feature that a ball touches, and how high its centre is then.
  struct Touch {
    FeatureKey feature;
    long double height;
  };
  /// Lets the ball's centre down at (x, y): the highest touch first, then all others that differ from it by at most
  /// `tie`. Empty if it touches nothing.
  void lower(double x, double y, double radius, double tie, std::vector<Touch>& touches) const;

  /// Distance from c to the solid if less than `limit`, otherwise `limit`. Zero inside.
  double distance(Space<double> c, double limit) const;
  /// The same in quadruple precision.
  double distance_carefully(Space<double> c, double limit) const;
  /// Distance in the plane to the projection if less than `limit`, otherwise `limit`.
  double plane_distance(double x, double y, double limit) const;

 private:
  Space<double> corner(std::uint32_t t, int k) const { return Space<double>(vertices_[triangles_[t][std::size_t(k)]]); }

  template <class T>
  double distance_in(Space<double> c, double limit) const;

  Point3 origin_;
  double resolution_;
  std::vector<Point3> vertices_;                         // ascending
  std::vector<std::array<std::uint32_t, 3>> triangles_;  // vertices ascending
  BoxHierarchy tree_;
};

}  // namespace krepl::verify
