#include "krepl/drop_cutter.hpp"
#include "krepl/mill.hpp"
#include "mill/links.hpp"
#include "mill/plan.hpp"
#include "mill/scallop_passes.hpp"
#include "model/radius_check.hpp"

namespace krepl {
namespace {

Result<MilledPath> run_job(const std::shared_ptr<const Terrain>& part, const mill::ScallopJob& job, const Context& context) {
  const Result<mill::Plan> plan = mill::make_plan(*part, job.tool, job.accuracy, job.motion, {});
  if (!plan) return plan.error();
  if (Status checked = mill::check(job); !checked) return checked.error();
  const Result<DropCutter> cutter = DropCutter::build(part, plan->radius, context);
  if (!cutter) return cutter.error();
  MilledPath milled;
  Result<std::vector<mill::Cut>> cuts = mill::scallop_cuts(part, *cutter, *plan, job, milled.report, context);
  if (!cuts) return cuts.error();
  if (cuts->empty())
    return job.after > 0 ? Error{ErrorCode::input, "the larger tool leaves no more than the threshold", "", "use a smaller threshold"}
                         : Error{ErrorCode::input, "there is no pass over the part", "", "use a smaller scallop"};
  milled.report.cuts = cuts->size();
  const auto links = mill::links_of(*plan, job.tool, job.accuracy, job.motion, job.motion.plunge_feed, job.tool.radius);
  return mill::finish_path(*cutter, std::move(*cuts), links, job.motion, std::move(milled), context);
}

}  // namespace

Result<MilledPath> mill_scallop(std::shared_ptr<const Terrain> part, const ScallopOptions& o, const Context& context) {
  return run_job(part, {o.tool, o.accuracy, o.motion, o.scallop, o.valley_angle, 0, 0}, context);
}

Result<MilledPath> mill_rest(std::shared_ptr<const Terrain> part, const RestOptions& o, const Context& context) {
  const double threshold = o.threshold < 0 ? o.scallop : o.threshold;
  if (!mill::is_positive(o.after) || !(o.after > o.tool.radius))
    return mill::usage("the radius of the tool before is not a finite number greater than that of the tool", "");
  if (!(threshold >= o.accuracy.tolerance && threshold < o.tool.radius))
    return mill::usage("the threshold " + shown(threshold) + " is not between the tolerance and the tool's radius", "");
  return run_job(part, {o.tool, o.accuracy, o.motion, o.scallop, o.valley_angle, o.after, threshold}, context);
}

}  // namespace krepl
