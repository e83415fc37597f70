#pragma once

#include <memory>

#include "krepl/drop_cutter.hpp"
#include "mill/line_bodies.hpp"

namespace krepl::mill {

/// A drop cutter with a tool that is larger than the one that moves by so much on all sides: the moving tool's control
/// point is `lift` above that of the larger one (balls have it in their common centre). The drop cutter must outlive
/// it.
struct LiftedCutter {
  LiftedCutter(const DropCutter& cutter, double lift_ = 0) : drop(cutter), lift(lift_) {}
  const DropCutter& drop;
  double lift;

  /// How high the control point is at least, relative to the part's origin; -infinity where nothing is touched.
  double height(Point place) const { return drop.at(place).height + lift; }
};

/// What the control point must stay above along lines. For cutters that are no balls, bodies below others by `slack`
/// may be left out in favour of planes that are so much too high at most; 0 or less: none.
std::unique_ptr<LineBodies> make_bodies(const LiftedCutter& cutter, double slack);

}  // namespace krepl::mill
