#pragma once

#include <vector>

#include "mill/boundary.hpp"
#include "mill/lifted_cutter.hpp"
#include "mill/pass_layout.hpp"

namespace krepl::mill {

/// Places of a pass, both ends included.
struct PassRange {
  std::int64_t first, last;
};

struct PassLimits {
  Boundary boundary;
  double shallow = 0;  ///< only where the surface of the control point is less steep than that, radians; 0: everywhere
  double overlap = 0;  ///< how far from there passes go on, along and across
};

/// The parts of a pass that are cut, in their order, each of two places at least. Steepness is looked at in places a
/// quarter of the overlap apart along the pass, and half of it across.
std::vector<PassRange> limit_pass(const LiftedCutter& cutter, const PassLayout& layout, const PassLayout::Pass& pass,
                                  const PassLimits& limits);

}  // namespace krepl::mill
