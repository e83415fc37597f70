#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "krepl/drop_cutter.hpp"

namespace krepl::test {

/// A terrain by its triangles alone, as its grid or mesh was meant, relative to the terrain's origin: what brute force needs.
struct DropCase {
  std::string name;
  std::shared_ptr<const Terrain> terrain;
  std::vector<std::array<Point3, 3>> triangles;
  double cell = 1;  ///< length to choose radii by

  double scale(double radius) const { return std::max(terrain->extent(), radius); }
};

/// Height of the ball's centre over a place, by no formula of the drop cutter: for each triangle, the highest point of the
/// vertical line that is no farther than R from it, by bisection on the distance of a point and a triangle in space.
/// Nothing if no triangle is within R of the line. `exactly`: in quadruple precision rather than extended.
std::optional<double> brute_height(const DropCase& c, Point place, double radius, bool exactly);

/// What is wrong with a contact, or nothing: its height, whether the touched point lies on the feature and at distance R
/// from the centre, and on no feature of lower dimension.
std::optional<std::string> fault_of(const DropCase& c, Point place, double radius, const DropCutter::Contact& contact);

}  // namespace krepl::test
