#pragma once

#include <vector>

#include "mill/line_bodies.hpp"
#include "terrain/drop_cutter_stretch.hpp"

namespace krepl::mill {

/// The sums of a ball with each of a terrain's triangles: krepls, of which only the upper side counts.
class BallBodies final : public LineBodies {
 public:
  explicit BallBodies(const DropCutter& cutter)
      : search_(cutter), radius_(cutter.radius()), squared_(cutter.radius() * cutter.radius()) {}

  bool list(const Line& line, double from, double to, double floor, bool all) override;
  bool touches() const override { return search_.touches(); }
  std::size_t size() const override { return parts_.size(); }
  Interval domain(std::size_t body) const override;
  Touch at(std::size_t body, double t) const override;
  double top_of_narrow(std::size_t body, double width) const override;
  double stretch() const override;

 private:
  drop::StretchSearch search_;
  double radius_, squared_;
  Line line_;
  std::vector<drop::Part> parts_;
};

}  // namespace krepl::mill
