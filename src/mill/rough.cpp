#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "krepl/drop_cutter.hpp"
#include "mill/plan.hpp"
#include "mill/rough_job.hpp"
#include "model/radius_check.hpp"

namespace krepl {
namespace {

using mill::Plan;

Status check(const RoughOptions& o) {
  if (!mill::is_positive(o.step_over))
    return mill::usage("the step-over is not a finite number greater than zero", "give one in the unit of the part");
  if (!mill::is_positive(o.step_down))
    return mill::usage("the step down is not a finite number greater than zero", "give one in the unit of the part");
  if (!(o.ramp_angle > 0 && o.ramp_angle < 90))
    return mill::usage("the ramp's angle is not between 0 and 90 degrees", "");
  if (!std::isfinite(o.stock_margin) || o.stock_margin < 0)
    return mill::usage("the stock's margin is not a finite number of zero or more", "");
  return std::monostate{};
}

/// The options that both strategies check alike.
ParallelOptions as_parallel(const RoughOptions& o) {
  ParallelOptions p;
  p.tool = o.tool, p.accuracy = o.accuracy, p.motion = o.motion, p.step_over = o.step_over, p.angle = o.angle,
  p.bottom = o.bottom;
  p.zigzag = true;
  return p;
}

/// Heights of levels in units, from the top of the stock (which is not cut) down.
Result<std::vector<std::int64_t>> level_heights(const Terrain& part, const Plan& plan, const RoughOptions& o) {
  const double unit = o.accuracy.unit, high = part.highest().z + part.origin().z;
  const double top_of_stock = o.stock_top ? *o.stock_top : high;
  if (!std::isfinite(top_of_stock) || top_of_stock < high)
    return mill::usage("the stock's top " + shown(top_of_stock) + " is below the part's, " + shown(high), "");
  // The tip's heights, as those of the control point.
  const double tip_to_control = (plan.lift == 0 ? mill::radius_of(o.tool) : 0) - plan.tip;
  const auto top = std::int64_t(std::ceil((top_of_stock + tip_to_control) / unit));
  const auto bottom = std::int64_t(std::ceil((plan.floor - plan.z0) / unit)) + 1;  // not below by rounding
  if (bottom >= top) return mill::usage("the lowest level is not below the stock's top", "");
  auto heights = mill::spread_levels(top, bottom, unit, o.step_down);
  if (!heights || o.pattern == RoughPattern::zigzag) return heights;
  // Levels are often at the height of level ground: arcs are proven free as chords, by a somewhat larger tool.
  const auto room = std::int64_t(std::ceil(mill::make_band(plan, o.accuracy).proof_room / unit));
  for (std::size_t n = 1; n < heights->size(); ++n) (*heights)[n] = std::min((*heights)[n] + room, top);
  return heights;
}

}  // namespace

Result<MilledPath> mill_rough(std::shared_ptr<const Terrain> part, const RoughOptions& o, const Context& context) {
  if (Status checked = check(o); !checked) return checked.error();
  Result<Plan> made = mill::make_plan(*part, as_parallel(o), mill::Cutters::all);
  if (!made) return made.error();
  Plan& plan = *made;
  const auto heights = level_heights(*part, plan, o);
  if (!heights) return heights.error();
  const double unit = o.accuracy.unit, top = double(heights->front()) * unit + plan.tip;
  if (!o.motion.safe_height)
    plan.safe = std::max(plan.safe, std::ceil((top + mill::radius_of(o.tool) - plan.tip) / unit) * unit + plan.tip);
  if (plan.safe < top)
    return mill::usage("the safe height " + shown(*o.motion.safe_height) + " is below the stock's top", "");
  const Result<DropCutter> cutter = DropCutter::build(part, plan.cutter, context);
  if (!cutter) return cutter.error();
  const mill::RoughJob job{o, plan, {*cutter, plan.lift}, *heights};
  MilledPath milled;
  Result<ToolPath> path = o.pattern == RoughPattern::zigzag ? mill::rough_by_zigzag(job, milled.report, context)
                                                            : mill::rough_by_offsets(job, milled.report, context);
  if (!path) return path.error();
  milled.path = std::move(*path);
  if (milled.path.moves.empty()) return Error{ErrorCode::input, "there is nothing to rough", "", "use a smaller tool"};
  milled.report.levels = heights->size() - 1;
  mill::measure(milled.path, o.motion, milled.report);
  return milled;
}

}  // namespace krepl
