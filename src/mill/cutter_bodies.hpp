#pragma once

#include <vector>

#include "mill/lifted_cutter.hpp"
#include "terrain/drop_cutter_stretch.hpp"

namespace krepl::mill {

/// The sums of a cutter that is no ball, upside down, with each of a terrain's triangles. They are convex as the cutter
/// is, and their heights may jump where they begin and end: where the rim of a flat cutter passes over a corner.
///
/// Over level ground a flat cutter touches everything at once. What is no more than `slack` above one triangle's body
/// is replaced by a plane so much above that: the last of the bodies.
class CutterBodies final : public LineBodies {
 public:
  CutterBodies(const LiftedCutter& cutter, double slack)
      : search_(cutter.drop), tool_(cutter.drop.cutter()), lift_(cutter.lift), slack_(slack) {}

  bool list(const Line& line, double from, double to, double floor, bool all) override;
  bool touches() const override { return search_.touches(); }
  std::size_t size() const override { return parts_.size() + (search_.base().is_known ? 1 : 0); }
  Interval domain(std::size_t body) const override;
  Touch at(std::size_t body, double t) const override;
  double top_of_narrow(std::size_t body, double width) const override;
  double stretch() const override;

 private:
  drop::StretchSearch search_;
  drop::ProfileTool tool_;
  double lift_, slack_;
  Line line_;
  Interval listed_{0, 0};
  std::vector<drop::Part> parts_;
};

}  // namespace krepl::mill
