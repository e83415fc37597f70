#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "input/subdivision_file.hpp"
#include "krepl/context.hpp"

namespace krepl::measure {

/// A number and where it is found.
struct Placed {
  double value = 0;
  Point3 at{};
  bool found = false;

  void raise(double other, Point3 place) {
    if (!found || other > value) *this = {other, place, true};
  }
  void lower(double other, Point3 place) {
    if (!found || other < value) *this = {other, place, true};
  }
};

/// Valleys of one kind: where the ball touches two places at once.
struct Valleys {
  std::size_t count = 0;
  double length = 0;
  /// Largest angle between the directions in which the ball touches, in radians: the sharper the valley, the larger.
  Placed turn;
  /// R (1 / cos(turn / 2) - 1): how far the ball stays off the line in which the two planes that it touches would meet.
  Placed depth;
};

/// A surface in numbers. Lengths, areas and places are those of the file's coordinates.
struct SurfaceMeasure {
  double radius = 0, scale = 0;
  std::size_t vertices = 0, edges = 0, faces = 0, holes = 0;
  struct Faces {
    std::size_t count = 0;
    double area = 0, projected = 0;  ///< of the surface itself, and seen from above
  };
  std::array<Faces, 3> by_feature;  ///< touching a vertex (spheres), an edge (cylinders), a face (planes)
  struct Edges {
    std::size_t count = 0;
    double length = 0;
  };
  std::array<Edges, 3> by_kind;   ///< seams, valleys, rims (the upper side of each)
  std::array<Edges, 4> by_curve;  ///< lines, circles, ellipses, quartics

  Placed shortest_edge, smallest_face;
  Point3 lowest{}, highest{};  ///< of the vertices
  /// Creases: the two features share a point of the input, so the ball rolls along an inner edge or corner and touches
  /// both sides. Bridges: they do not; something lies between that the ball does not reach.
  Valleys creases, bridges;
  /// Half the least and the largest distance of the two places touched over bridges: no larger ball gets between them.
  Placed narrowest_bridge, widest_bridge;
  /// Largest difference between R and the distance of an edge's points from what the ball touches there.
  Placed residual;
};

/// Lengths and areas along the true curves, which are made anew from the features, to about 1e-10 of the value. Errors:
/// indices out of range, loops that do not close (named); cancelled. O(size of the file), on all threads.
Result<SurfaceMeasure> measure_surface(const input::SubdivisionFile& file, const Context& context = {});

}  // namespace krepl::measure
