#pragma once

#include "krepl/drop_cutter.hpp"
#include "terrain/drop_cutter_stretch.hpp"

namespace krepl::mill {

/// How steep the surface of a cutter's control point is. Keeps what was touched last: one for each thread; the cutter
/// must outlive it.
class Steepness {
 public:
  explicit Steepness(const DropCutter& cutter) : cutter_(cutter), search_(cutter) {}
  /// Radians from level; beside the part level.
  double at(Point place);

 private:
  const DropCutter& cutter_;
  drop::StretchSearch search_;
};

}  // namespace krepl::mill
