#pragma once

#include <memory>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/drop_cutter.hpp"
#include "krepl/mill.hpp"
#include "mill/links.hpp"
#include "mill/plan.hpp"

namespace krepl::mill {

/// What passes at constant scallops need to know, for the whole surface or for what a larger tool has left.
struct ScallopJob {
  MillTool tool;
  MillAccuracy accuracy;
  MillMotion motion;
  double scallop = 0;
  double valley_angle = 0;  ///< degrees
  double after = 0;         ///< radius of the larger tool; 0: none
  double threshold = 0;     ///< of what that has left
};

Status check(const ScallopJob& job);

/// Cuts along valleys and along lines at constant distances from them and from the border, as SurfaceGrid measures them; more of
/// them between where CoverProof does not find the scallop kept; in an order of short ways.
///
/// Errors: those of compute_surface; a raster of more than 2^24 places (usage); cancelled.
Result<std::vector<Cut>> scallop_cuts(const std::shared_ptr<const Terrain>& part, const DropCutter& cutter, const Plan& plan,
                                      const ScallopJob& job, MillReport& report, const Context& context);

}  // namespace krepl::mill
