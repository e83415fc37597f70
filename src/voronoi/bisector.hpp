#pragma once

#include <optional>
#include <vector>

#include "krepl/voronoi.hpp"
#include "voronoi/sites.hpp"

namespace krepl::voronoi {

/// The curve of an edge in a frame with x along it: the focus over the directrix of a parabola, the foot of the common
/// perpendicular of two vertices, or just a straight line. Coordinates relative to the network's origin.
class Bisector {
 public:
  Bisector(const Network& network, const VoronoiDiagram::Edge& edge, Point start, Point end);

  /// Points from start to end, at most max_clearance from the sites; chords deviate by max_error at most.
  std::vector<Point> points(double max_error, double max_clearance) const;
  /// Where the tangents at the ends of that stretch meet; nothing for straight curves.
  std::optional<Point> control_point(double max_clearance) const;
  /// The largest distance from the curve of so many chords of equal width over all of it.
  double chord_error(std::size_t chords) const {
    const double width = (end_ - start_) / double(chords);
    return parabola_ ? width * width / (8 * height_) : 0;
  }

 private:
  Point at(double x) const;
  /// The stretches of x, from start to end, where the clearance is at most the given one.
  bool clip(double max_clearance, double& from, double& to) const;

  bool parabola_ = false, two_vertices_ = false;
  Vector<double> origin_{}, along_{}, up_{};
  double height_ = 0;  // of the focus over the directrix; of two vertices half their distance
  double start_ = 0, end_ = 0;
  double start_clearance_ = 0, end_clearance_ = 0;
  Point first_, last_;
};

}  // namespace krepl::voronoi
