#include "krepl/mill.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/parallel.hpp"
#include "krepl/drop_cutter.hpp"
#include "mill/curve_fit.hpp"
#include "mill/lifted_cutter.hpp"
#include "mill/links.hpp"
#include "mill/pass_layout.hpp"
#include "mill/pass_limits.hpp"
#include "mill/plan.hpp"
#include "mill/scallops.hpp"

namespace krepl {
namespace {

using mill::CurveFit;
using mill::CurveRun;
using mill::Cut;
using mill::FittedMove;
using mill::LatticePoint;
using mill::Plan;

/// Moves of one pass as they are in space.
class PassMoves {
 public:
  PassMoves(const mill::PassLayout& layout, const Plan& plan, const ParallelOptions& options)
      : layout_(layout), plan_(plan), o_(options) {}

  Cut cut(const mill::PassLayout::Pass& pass, LatticePoint start, const std::vector<FittedMove>& moves,
          bool backwards) const {
    Cut cut;
    cut.start = point(pass, backwards && !moves.empty() ? moves.back().end : start);
    for (std::size_t n = 0; n < moves.size(); ++n) {
      const FittedMove& m = moves[backwards ? moves.size() - 1 - n : n];
      LatticePoint end = m.end;
      if (backwards) end = n + 1 < moves.size() ? moves[moves.size() - 2 - n].end : start;
      cut.moves.push_back(move(pass, m, end, backwards));
    }
    return cut;
  }

 private:
  Point3 point(const mill::PassLayout::Pass& pass, LatticePoint at) const {
    const double unit = o_.accuracy.unit;
    return {double(pass.i0 + at.i * layout_.p) * unit, double(pass.j0 + at.i * layout_.q) * unit,
            double(at.k) * unit + plan_.tip};
  }
  /// An arc over a top turns clockwise as seen from the right of the way. From +Y one looks at the right side of a way
  /// along -x, from +X at that of a way along y.
  Move move(const mill::PassLayout::Pass& pass, const FittedMove& m, LatticePoint end, bool backwards) const {
    Move move;
    move.end = point(pass, end);
    move.feed = o_.motion.feed;
    if (m.kind == FittedMove::Kind::line) return move;
    move.centre = point(pass, m.centre);
    const bool along_x = layout_.q == 0;
    move.plane = along_x ? ArcPlane::zx : ArcPlane::yz;
    const bool seen_from_right = ((along_x ? layout_.p < 0 : layout_.q > 0)) != backwards;
    const bool over = m.kind == FittedMove::Kind::over;
    move.kind = over == seen_from_right ? MoveKind::clockwise : MoveKind::counter_clockwise;
    return move;
  }

  const mill::PassLayout& layout_;
  const Plan& plan_;
  const ParallelOptions& o_;
};

struct PassResult {
  std::vector<Cut> cuts;
  std::size_t points = 0;
  std::uint64_t touches = 0;
};

PassResult make_pass(const mill::LiftedCutter& cutter, const mill::PassLayout& layout, std::size_t k, const Plan& plan,
                     const mill::PassLimits& limits, const ParallelOptions& o) {
  const mill::PassLayout::Pass& pass = layout.passes[k];
  const std::unique_ptr<mill::LineBodies> bodies = mill::make_bodies(cutter, plan.slack);
  mill::DriveCurve curve(*bodies, {plan.floor, plan.accuracy, o.accuracy.unit / 64, layout.step});
  std::vector<CurveRun> runs;
  for (const mill::PassRange& range : mill::limit_pass(cutter, layout, pass, limits))
    curve.trace(layout.line(pass), double(range.first) * layout.step, double(range.last) * layout.step,
                o.bottom.has_value(), runs);
  PassResult result;
  result.touches = curve.touches();
  mill::FitOptions fit{layout.step, o.accuracy.unit, plan.z0, plan.band, o.accuracy.arc_error, 0};
  if (o.accuracy.arcs && layout.is_along_axis()) fit.most_radius = 64 * (plan.radius + cutter.drop.terrain().extent());
  const PassMoves in_space(layout, plan, o);
  for (const CurveRun& run : runs) {
    std::vector<FittedMove> moves;
    const LatticePoint start = CurveFit(run, fit).run(moves);
    result.cuts.push_back(in_space.cut(pass, start, moves, pass.backwards));
    result.points += run.size();
  }
  if (pass.backwards) std::reverse(result.cuts.begin(), result.cuts.end());
  return result;
}

/// Adds passes where the scallop asked for would be exceeded between those laid out.
bool refine_passes(const DropCutter& cutter, mill::PassLayout& layout, const Plan& plan, const ParallelOptions& o,
                   MillReport& report, const Context& context) {
  if (layout.passes.size() < 2) return true;
  std::vector<mill::ExtraPasses> extra(layout.passes.size() - 1);
  mill::ScallopOptions scallops;
  scallops.radius = cutter.radius(), scallops.height = o.scallop - o.accuracy.tolerance,
  scallops.every = plan.step_over / 2;
  Context quiet;
  quiet.threads = context.threads, quiet.cancel = context.cancel;
  const bool done = kernel::parallel_blocks(quiet, extra.size(), 1, [&](std::size_t k, std::size_t) {
    const std::unique_ptr<mill::LineBodies> bodies = mill::make_bodies(cutter, 0);
    const double accuracy = std::max(plan.accuracy, scallops.height / 16);
    mill::DriveCurve curve(*bodies, {plan.floor, accuracy, o.accuracy.unit / 64, layout.step});
    extra[k] = mill::find_extra_passes(curve, layout, layout.passes[k], layout.passes[k + 1], scallops);
  });
  std::vector<mill::PassLayout::Pass> passes;
  bool backwards = false;
  for (std::size_t k = 0; k < layout.passes.size(); ++k) {
    layout.passes[k].backwards = o.zigzag && backwards;
    passes.push_back(layout.passes[k]);
    backwards = !backwards;
    if (k == extra.size()) break;
    report.extra_passes += extra[k].passes.size(), report.sections += extra[k].sections,
        report.uneven_sections += extra[k].remaining;
    if (extra[k].passes.empty()) continue;
    // The pieces of a gap on the way back, whatever line they are on.
    std::stable_sort(extra[k].passes.begin(), extra[k].passes.end(), [backwards](const auto& a, const auto& b) {
      return backwards ? a.last > b.last : a.first < b.first;
    });
    for (mill::PassLayout::Pass& pass : extra[k].passes) {
      pass.backwards = o.zigzag && backwards;
      passes.push_back(pass);
    }
    backwards = !backwards;
  }
  layout.passes = std::move(passes);
  return done;
}

}  // namespace

Result<MilledPath> mill_parallel(std::shared_ptr<const Terrain> part, const ParallelOptions& o,
                                 const Context& context) {
  Result<Plan> made = mill::make_plan(*part, o, mill::Cutters::all);
  if (!made) return made.error();
  Plan& plan = *made;
  const Result<DropCutter> drop = DropCutter::build(part, plan.cutter, context);
  if (!drop) return drop.error();
  const mill::LiftedCutter cutter(*drop, plan.lift);
  mill::PassLayout layout =
      mill::lay_passes(*part, o.accuracy.unit, o.angle, plan.step_over, plan.radius, o.accuracy.tolerance);
  plan.band -= layout.step;
  for (std::size_t k = 1; k < layout.passes.size(); k += 2) layout.passes[k].backwards = o.zigzag;
  MilledPath milled;
  if (o.scallop != 0 && !refine_passes(*drop, layout, plan, o, milled.report, context))
    return Error{ErrorCode::cancelled, "cancelled", "", ""};
  const mill::PassLimits limits{mill::Boundary(o.boundary, part->origin()), o.shallow * std::numbers::pi / 180,
                                plan.step_over};
  std::vector<PassResult> results(layout.passes.size());
  kernel::Progress progress(context, results.size());
  const bool done = kernel::parallel_blocks(context, results.size(), 1, [&](std::size_t k, std::size_t) {
    results[k] = make_pass(cutter, layout, k, plan, limits, o);
    progress.add(1);
  });
  if (!done) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  std::vector<Cut> cuts;
  for (PassResult& r : results) {
    milled.report.curve_points += r.points, milled.report.touches += r.touches;
    for (Cut& c : r.cuts) cuts.push_back(std::move(c));
  }
  if (cuts.empty())
    return Error{ErrorCode::input, "there is no pass over the part", "",
                 o.boundary.polygons.empty() ? "use a smaller step-over" : "use a smaller step-over or a larger boundary"};
  milled.report.passes = results.size(), milled.report.cuts = cuts.size();
  milled.report.step_over = layout.step_over, milled.report.angle = layout.angle();
  const double short_link = o.zigzag ? 1.5 * plan.step_over : 0;
  mill::LinkOptions links = mill::links_of(plan, o.tool, o.accuracy, o.motion, o.motion.feed, short_link);
  links.boundary = &limits.boundary;
  return mill::finish_path(cutter, std::move(cuts), links, o.motion, std::move(milled), context);
}

}  // namespace krepl
