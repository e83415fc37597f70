#pragma once

#include <cstdint>
#include <vector>

#include "krepl/point.hpp"

namespace krepl {

/// The part of a zone that belongs to one owner: the places of the zone that are nearest to the parts of the network
/// that it owns. Shares of all owners cover the zone without overlap; where two meet, both have the same points.
struct OwnerZone {
  enum class Kind : std::uint8_t {
    segment,  ///< straight
    arc,      ///< of the zone's radius about `center`, counter-clockwise; start == end: the full circle
    bisector  ///< of a parabola, equally far from two owners: a chain of chords
  };
  /// A piece of a ring, in absolute coordinates; it ends where the next one starts.
  struct Curve {
    Kind kind = Kind::segment;
    std::vector<Point> points;  ///< start and end; bisectors: those between them too
    Point center;               ///< arcs only
  };
  struct Ring {
    std::vector<Curve> curves;  ///< the share on the left
    double area = 0;            ///< negative for holes
    double length = 0;
  };
  struct Polygon {
    Ring outer;
    std::vector<Ring> holes;
  };

  std::uint32_t owner = 0;
  std::vector<Polygon> polygons;
  double area = 0, perimeter = 0;
  double deviation = 0;  ///< the largest distance between a chord and its parabola
};

}  // namespace krepl
