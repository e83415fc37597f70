#pragma once

#include "krepl/terrain.hpp"

namespace krepl::mill {

/// The unit normal of the surface of a ball's centre at p where the ball touches a feature of the terrain: away from
/// that, upwards if it is a face. {0, 0, 1} where it cannot be told.
Point3 touch_normal(const Terrain& terrain, Terrain::Index feature, Point3 p);

}  // namespace krepl::mill
