#pragma once

#include "input/subdivision_file.hpp"
#include "kernel/vectors.hpp"

namespace krepl::measure {

using namespace vectors;

/// What the ball touches, and the plane, cylinder or sphere of its centre.
struct Touched {
  int count = 0;             ///< of the feature's points: vertex 1, edge 2, face 3
  Point3 at{}, direction{};  ///< a point; along an edge, or a face's upward normal
  Point3 over{};             ///< edges: upwards, across the edge

  Point3 foot(Point3 centre) const;    ///< where a ball about `centre` touches the whole plane or line
  Point3 normal(Point3 centre) const;  ///< from there to the centre
  /// How far the centre is from where it touches with radius R, less R.
  double off(Point3 centre, double radius) const;
  double height(Point3 place, double radius) const;
  /// Half of what a step along the border of a face adds to the face's area (Green's theorem on the patch).
  double area_step(Point3 a, Point3 b, double radius) const;
};

/// `origin` is taken off all coordinates.
Touched touched(const input::SubdivisionFile::Feature& feature, Point3 origin);

/// The true curve of an edge.
class EdgeCourse {
 public:
  EdgeCourse(const input::SubdivisionFile& file, input::SubdivisionFile::Index edge, Point3 origin);

  /// The point of the curve next to one that is near it.
  Point3 nearest(Point3 near) const;
  /// Null where the ball touches nothing on that side.
  const Touched* side(int s) const { return has_[s] ? &side_[s] : nullptr; }

 private:
  Point3 on_valley(Point3 near) const;

  const input::SubdivisionFile::Edge& edge_;
  double radius_;
  Touched side_[2];
  bool has_[2];
};

}  // namespace krepl::measure
