#include "section/edge_course.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/vectors.hpp"
#include "terrain/curve.hpp"

namespace krepl::section {

using namespace vectors;

EdgeCourse::EdgeCourse(const Parts& parts, Index e) : surface_(*parts.surface), edge_(surface_.edge(e)) {
  const Subdivision& topology = parts.topology();
  Point3 a = surface_.vertex(topology.origin[2 * e]), b = surface_.vertex(topology.origin[2 * e + 1]);
  if (edge_.curve == Surface::Curve::line && edge_.kind != Surface::EdgeKind::rim) {
    a.z = parts.corner_height(2 * e);  // it may end at the foot of a wall
    b.z = parts.corner_height(2 * e + 1);
    samples_ = {a, b};
    return;
  }
  // A level or a line crosses a circle or an ellipse twice at most, but other curves, and what is below a rim, more often.
  const bool twisted = !surface_.guides(e).empty() || edge_.curve == Surface::Curve::quartic;
  const double arc = distance(a, b) / surface_.radius();
  samples_ = surface_.curve(e, twisted ? 33 : std::clamp(5 + int(std::min(16 * arc, 12.0)), 5, 17));
  for (std::size_t i = 1; i < samples_.size(); ++i) length_ += distance(samples_[i - 1], samples_[i]);
}

Point3 EdgeCourse::at(double s) const {
  const double place = s * double(samples_.size() - 1);
  const std::size_t i = std::min(std::size_t(std::max(place, 0.0)), samples_.size() - 2);
  const double t = place - double(i);
  if (t <= 0) return samples_[i];
  if (t >= 1) return samples_[i + 1];
  const Point3 near = samples_[i] + t * (samples_[i + 1] - samples_[i]);
  if (edge_.curve == Surface::Curve::line) return near;
  const Point3 p = terrain::project_to_curve(surface_.terrain(), surface_.radius(), edge_, near, length_);
  return distance(p, near) > length_ ? near : p;
}

}  // namespace krepl::section
