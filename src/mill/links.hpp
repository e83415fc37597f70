#pragma once

#include <cstdint>
#include <vector>

#include "krepl/drop_cutter.hpp"
#include "krepl/mill.hpp"
#include "mill/boundary.hpp"
#include "mill/lifted_cutter.hpp"
#include "mill/plan.hpp"

namespace krepl::mill {

/// Moves at the feed without a break, from `start`; absolute coordinates of the ball's centre.
struct Cut {
  Point3 start;
  std::vector<Move> moves;
  Point3 end() const { return moves.empty() ? start : moves.back().end; }
};

/// How cuts are put together.
struct LinkOptions {
  double safe_height;  ///< of the ball's centre, above everything
  double clearance;    ///< of rapid moves
  double feed, plunge_feed;
  double short_link;  ///< links up to this length are taken at the feed, without clearance
  double floor;       ///< relative to the part's origin, of the ball's centre
  double unit, z0;    ///< heights are z0 + k unit
  const Boundary* boundary = nullptr;  ///< links that leave it are taken at the safe height
};

/// One path of all cuts in their order. Links go straight up, level and straight down; level parts are above the
/// highest place of the cutter's surface (proven by bounds) below them.
Result<ToolPath> link_cuts(const LiftedCutter& cutter, std::vector<Cut>&& cuts, const LinkOptions& options,
                           const Context& context);

/// How a strategy links its cuts: with the clearance that is asked for, else half the tool's radius; down to the plan's floor.
LinkOptions links_of(const Plan& plan, const MillTool& tool, const MillAccuracy& accuracy, const MillMotion& motion,
                     double feed, double short_link);

/// link_cuts, as the path of `milled`, which has the report so far: counts and lengths are added.
Result<MilledPath> finish_path(const LiftedCutter& cutter, std::vector<Cut>&& cuts, const LinkOptions& options,
                               const MillMotion& motion, MilledPath milled, const Context& context);

}  // namespace krepl::mill
