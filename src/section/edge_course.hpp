#pragma once

#include <vector>

#include "section/parts.hpp"

namespace krepl::section {

/// An edge of a surface as a curve over [0, 1], along half-edge 2e. At a rim z is that of the upper patch.
class EdgeCourse {
 public:
  EdgeCourse(const Parts& parts, Index edge);

  /// Points at equal steps of the parameter, both ends included.
  const std::vector<Point3>& samples() const { return samples_; }
  bool is_straight() const { return samples_.size() == 2; }
  Point3 at(double s) const;

 private:
  const Surface& surface_;
  Surface::Edge edge_;
  std::vector<Point3> samples_;
  double length_ = 0;
};

}  // namespace krepl::section
