#include "krepl/mill.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "kernel/parallel.hpp"
#include "krepl/drop_cutter.hpp"
#include "mill/ball_bodies.hpp"
#include "mill/curve_fit.hpp"
#include "mill/links.hpp"
#include "mill/pass_layout.hpp"
#include "mill/scallops.hpp"
#include "model/radius_check.hpp"

namespace krepl {
namespace {

using mill::CurveFit;
using mill::CurveRun;
using mill::Cut;
using mill::FittedMove;
using mill::LatticePoint;

Error usage(const std::string& what, const std::string& remedy) { return {ErrorCode::usage, what, "", remedy}; }

constexpr double gentle = 0.9;  // the cosine of 26 degrees

bool is_positive(double x) { return std::isfinite(x) && x > 0; }

/// Lengths that follow from the options, all relative to the part's origin.
struct Plan {
  double radius;    // of the cutter as it is computed with: allowance and room for the lattice's arcs
  double accuracy;  // of drive curves
  double band;      // for fitting
  double tip;       // from the control point's height to that of the centre
  double z0;        // a height of the lattice, of the centre
  double floor;     // of the centre
  double safe;      // absolute, of the centre
  double step_over;
};

Status check(const ParallelOptions& o) {
  if (!is_positive(o.tool.radius))
    return usage("the tool's radius is not a finite number greater than zero", "give one in the unit of the part");
  if (!std::isfinite(o.tool.allowance) || o.tool.allowance < 0)
    return usage("the allowance is not a finite number of zero or more", "");
  if (!is_positive(o.accuracy.unit))
    return usage("the unit of coordinates is not a finite number greater than zero", "");
  if (!is_positive(o.accuracy.tolerance)) return usage("the tolerance is not a finite number greater than zero", "");
  if (o.accuracy.tolerance < 16 * o.accuracy.unit + 2 * o.accuracy.arc_error)
    return usage("the tolerance " + shown(o.accuracy.tolerance) + " is too small for numbers that are multiples of " +
                     shown(o.accuracy.unit),
                 "use at least " + shown(16 * o.accuracy.unit + 2 * o.accuracy.arc_error) + ", or more decimals");
  if (!is_positive(o.motion.feed) || !is_positive(o.motion.plunge_feed) || !is_positive(o.motion.rapid_feed))
    return usage("a feed is not a finite number greater than zero", "give units a minute");
  if (!std::isfinite(o.angle)) return usage("the angle is not a finite number", "give degrees");
  if ((o.step_over != 0) == (o.scallop != 0))
    return usage("there is not one of step-over and scallop height", "give one of them");
  if (o.step_over != 0 && !is_positive(o.step_over))
    return usage("the step-over is not a finite number greater than zero", "");
  if (o.scallop != 0 && !(is_positive(o.scallop) && o.scallop <= o.tool.radius / 2))
    return usage("the scallop height is not between 0 and half the tool's radius", "");
  if (o.scallop != 0 && o.scallop <= 1.25 * o.accuracy.tolerance)
    return usage(
        "the scallop height " + shown(o.scallop) + " leaves no room for the tolerance " + shown(o.accuracy.tolerance),
        "use a tolerance of at most " + shown(o.scallop / 1.25));
  return std::monostate{};
}

/// Two balls of radius R at distance w leave a ridge of R - sqrt(R^2 - w^2 / 4) on a plane along the passes. Somewhat
/// less, so that gentle slopes across them need no further passes.
double step_over_of(const ParallelOptions& o) {
  if (o.step_over != 0) return o.step_over;
  const double height = o.scallop - o.accuracy.tolerance, radius = o.tool.radius + o.tool.allowance;
  return gentle * 2 * std::sqrt(2 * radius * height - height * height);
}

Result<Plan> make_plan(const Terrain& part, const ParallelOptions& o) {
  if (Status checked = check(o); !checked) return checked.error();
  const MillAccuracy& a = o.accuracy;
  Plan plan;
  plan.radius = o.tool.radius + o.tool.allowance + 2 * a.unit;
  if (a.unit < 0x1p-34 * std::max({part.extent(), plan.radius, std::abs(part.origin().x), std::abs(part.origin().y)}))
    return usage("numbers that are multiples of " + shown(a.unit) + " are too fine for the part's coordinates",
                 "use fewer decimals");
  plan.accuracy = a.tolerance / 8;
  plan.band = a.tolerance - plan.accuracy - 4.5 * a.unit - a.arc_error;
  const Point3 origin = part.origin(), low = part.lowest(), high = part.highest();
  plan.tip = a.control_point == ControlPoint::tip ? o.tool.radius : 0;
  plan.z0 = plan.tip - origin.z;
  plan.floor = o.bottom ? *o.bottom + o.tool.radius - origin.z : low.z + plan.radius;
  const double top = std::max(high.z + plan.radius, plan.floor) + origin.z;
  const double height = o.motion.safe_height ? *o.motion.safe_height + plan.tip : top + o.tool.radius;
  plan.safe = std::ceil((height - plan.tip) / a.unit) * a.unit + plan.tip;
  if (plan.safe < top)
    return usage(
        "the safe height " + shown(*o.motion.safe_height) + " is below the highest place of the tool over the part",
        "use at least " + shown(top - plan.tip));
  plan.step_over = step_over_of(o);
  if (plan.step_over < 4 * a.unit)
    return usage("the step-over " + shown(plan.step_over) + " is too fine for the numbers' decimals", "");
  if (plan.step_over < 1e-6 * part.extent())
    return usage("the step-over " + shown(plan.step_over) + " means more than a million passes", "use a larger one");
  return plan;
}

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

PassResult make_pass(const DropCutter& cutter, const mill::PassLayout& layout, std::size_t k, const Plan& plan,
                     const ParallelOptions& o) {
  const mill::PassLayout::Pass& pass = layout.passes[k];
  mill::BallBodies bodies(cutter);
  mill::DriveCurve curve(bodies, {plan.floor, plan.accuracy, o.accuracy.unit / 64, layout.step});
  std::vector<CurveRun> runs;
  curve.trace(layout.line(pass), double(pass.first) * layout.step, double(pass.last) * layout.step,
              o.bottom.has_value(), runs);
  PassResult result;
  result.touches = curve.touches();
  mill::FitOptions fit{layout.step, o.accuracy.unit, plan.z0, plan.band, o.accuracy.arc_error, 0};
  if (o.accuracy.arcs && layout.is_along_axis()) fit.most_radius = 64 * (cutter.radius() + cutter.terrain().extent());
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
    mill::BallBodies bodies(cutter);
    const double accuracy = std::max(plan.accuracy, scallops.height / 16);
    mill::DriveCurve curve(bodies, {plan.floor, accuracy, o.accuracy.unit / 64, layout.step});
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

namespace mill {

/// Counts and lengths of a path.
void measure(const ToolPath& path, const MillMotion& motion, MillReport& report) {
  Point3 at = path.start;
  for (const Move& m : path.moves) {
    const bool arc = m.kind == MoveKind::clockwise || m.kind == MoveKind::counter_clockwise;
    double length = std::hypot(m.end.x - at.x, m.end.y - at.y, m.end.z - at.z);
    if (arc) {
      const double radius = m.plane == ArcPlane::zx   ? std::hypot(at.x - m.centre.x, at.z - m.centre.z)
                            : m.plane == ArcPlane::yz ? std::hypot(at.y - m.centre.y, at.z - m.centre.z)
                                                      : std::hypot(at.x - m.centre.x, at.y - m.centre.y);
      length = 2 * radius * std::asin(std::min(1.0, length / (2 * radius)));
    }
    if (m.kind == MoveKind::rapid)
      ++report.rapids, report.rapid_length += length, report.minutes += length / motion.rapid_feed;
    else
      ++(arc ? report.arcs : report.lines), report.cutting_length += length, report.minutes += length / m.feed;
    at = m.end;
  }
}

}  // namespace mill

Result<MilledPath> mill_parallel(std::shared_ptr<const Terrain> part, const ParallelOptions& o,
                                 const Context& context) {
  Result<Plan> made = make_plan(*part, o);
  if (!made) return made.error();
  Plan& plan = *made;
  const Result<DropCutter> cutter = DropCutter::build(part, plan.radius, context);
  if (!cutter) return cutter.error();
  mill::PassLayout layout =
      mill::lay_passes(*part, o.accuracy.unit, o.angle, plan.step_over, plan.radius, o.accuracy.tolerance);
  plan.band -= layout.step;
  for (std::size_t k = 1; k < layout.passes.size(); k += 2) layout.passes[k].backwards = o.zigzag;
  MilledPath milled;
  if (o.scallop != 0 && !refine_passes(*cutter, layout, plan, o, milled.report, context))
    return Error{ErrorCode::cancelled, "cancelled", "", ""};
  std::vector<PassResult> results(layout.passes.size());
  kernel::Progress progress(context, results.size());
  const bool done = kernel::parallel_blocks(context, results.size(), 1, [&](std::size_t k, std::size_t) {
    results[k] = make_pass(*cutter, layout, k, plan, o);
    progress.add(1);
  });
  if (!done) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  std::vector<Cut> cuts;
  for (PassResult& r : results) {
    milled.report.curve_points += r.points, milled.report.touches += r.touches;
    for (Cut& c : r.cuts) cuts.push_back(std::move(c));
  }
  if (cuts.empty()) return Error{ErrorCode::input, "there is no pass over the part", "", "use a smaller step-over"};
  milled.report.passes = results.size(), milled.report.cuts = cuts.size();
  milled.report.step_over = layout.step_over, milled.report.angle = layout.angle();
  const double clearance = o.motion.clearance >= 0 ? o.motion.clearance : o.tool.radius / 2;
  const double short_link = o.zigzag ? 1.5 * plan.step_over : 0;
  Result<ToolPath> path = mill::link_cuts(
      *cutter, std::move(cuts),
      {plan.safe, clearance, o.motion.feed, o.motion.plunge_feed, short_link, plan.floor, o.accuracy.unit, plan.tip},
      context);
  if (!path) return path.error();
  milled.path = std::move(*path);
  mill::measure(milled.path, o.motion, milled.report);
  return milled;
}

}  // namespace krepl
