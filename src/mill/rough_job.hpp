#pragma once

#include <cstdint>
#include <vector>

#include "mill/lifted_cutter.hpp"
#include "mill/plan.hpp"

namespace krepl::mill {

/// What both patterns of roughing work with.
struct RoughJob {
  const RoughOptions& o;
  const Plan& plan;
  LiftedCutter cutter;  ///< of the plan
  std::vector<std::int64_t>
      heights;  ///< of the stock's top, which is not cut, and of the levels, in units of the control point

  double above_tip() const { return plan.lift == 0 ? radius_of(o.tool) : 0; }  ///< the control point
  double level(std::int64_t k) const {
    return plan.z0 + double(k) * o.accuracy.unit;
  }  ///< relative to the part's origin
  double absolute(std::int64_t k) const { return double(k) * o.accuracy.unit + plan.tip; }
  double clearance() const { return o.motion.clearance >= 0 ? o.motion.clearance : radius_of(o.tool) / 2; }
};

/// In parallel passes, to and fro: `report` gets passes, cuts and what is skipped.
Result<ToolPath> rough_by_zigzag(const RoughJob& job, MillReport& report, const Context& context);

/// In rings parallel to the part, from outside of the stock inwards.
Result<ToolPath> rough_by_offsets(const RoughJob& job, MillReport& report, const Context& context);

}  // namespace krepl::mill
