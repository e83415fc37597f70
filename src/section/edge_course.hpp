#pragma once

#include <optional>
#include <vector>

#include "kernel/vectors.hpp"
#include "section/parts.hpp"

namespace krepl::section {

/// An edge of a surface as a curve over [0, 1], along half-edge 2e. At a rim z is that of the upper patch.
///
/// Where two patches meet, the nearest point of a curve is not enough to run along it: on steep ground it is drawn out
/// in height, and near its turn the other arm is as near. So circles run by their angle, curves on a cylinder by the
/// angle around its axis, which is between 0 and pi.
class EdgeCourse {
 public:
  EdgeCourse(const Parts& parts, Index edge);

  /// Points at equal steps of the parameter, both ends included.
  const std::vector<Point3>& samples() const { return samples_; }
  bool is_straight() const { return samples_.size() == 2; }
  Point3 at(double s) const;

 private:
  /// A cylinder, in a frame of its axis, left and up; and what else the ball touches.
  struct Around {
    Point3 at, along, left, up;
    Terrain::FeatureKind other_kind;
    Point3 other_at, other_direction;               ///< of an edge: along it; of a face: its normal
    double from = 0, to = 0;                        ///< angles
    std::vector<std::pair<double, double>> guides;  ///< angles, going one way, and places along the axis: which of two
                                                    ///< points of the same angle is meant
    double expected(double angle) const;
    int branch = 0;  ///< of a quartic: the larger (1) or smaller (-1) of two places of one angle, all along
  };
  struct Circle {
    Point3 centre, u, v;
    double from, to;
  };

  void find_circle(bool is_closed);
  void find_around();
  std::optional<Around> around(int side, const std::vector<Point3>& guides) const;
  struct Places {
    Point3 base;             ///< on the cylinder, of a certain angle
    double larger, smaller;  ///< along the axis from there, where it meets the other surface
  };
  std::optional<Places> places(const Around& a, double angle) const;
  int branch(const Around& a) const;
  std::optional<Point3> on_cylinder(double s) const;
  Point3 projected(Point3 near, double reach) const;

  const Surface& surface_;
  Surface::Edge edge_;
  std::vector<Point3> samples_;
  std::optional<Around> around_;
  std::optional<Circle> circle_;
  double length_ = 0;
};

}  // namespace krepl::section
