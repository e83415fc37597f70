#include "krepl/mill.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "kernel/parallel.hpp"
#include "kernel/vectors.hpp"
#include "krepl/drop_cutter.hpp"
#include "mill/cover_proof.hpp"
#include "mill/curve_fit.hpp"
#include "mill/cut_order.hpp"
#include "mill/interest.hpp"
#include "mill/lifted_cutter.hpp"
#include "mill/links.hpp"
#include "mill/pass_gaps.hpp"
#include "mill/pass_layout.hpp"
#include "mill/pass_limits.hpp"
#include "mill/plan.hpp"
#include "mill/plunges.hpp"

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

  Cut cut(const mill::PassLayout::Pass& pass, LatticePoint start, const std::vector<FittedMove>& moves) const {
    Cut cut;
    cut.start = point(pass, start);
    for (const FittedMove& m : moves) cut.moves.push_back(move(pass, m));
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
  Move move(const mill::PassLayout::Pass& pass, const FittedMove& m) const {
    Move move;
    move.end = point(pass, m.end);
    move.feed = o_.motion.feed;
    if (m.kind == FittedMove::Kind::line) return move;
    move.centre = point(pass, m.centre);
    const bool along_x = layout_.q == 0;
    move.plane = along_x ? ArcPlane::zx : ArcPlane::yz;
    const bool seen_from_right = along_x ? layout_.p < 0 : layout_.q > 0;
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

PassResult make_pass(const mill::LiftedCutter& cutter, const mill::PassLayout& layout,
                     const mill::PassLayout::Pass& pass, const Plan& plan, const mill::PassLimits& limits,
                     const ParallelOptions& o) {
  const std::unique_ptr<mill::LineBodies> bodies = mill::make_bodies(cutter, plan.slack);
  mill::DriveCurve curve(*bodies, {plan.floor, plan.accuracy, o.accuracy.unit / 64, layout.step});
  std::vector<CurveRun> runs;
  for (const mill::PassRange& range : mill::limit_pass(cutter, layout, pass, limits))
    curve.trace(layout.line(pass), double(range.first) * layout.step, double(range.last) * layout.step,
                o.bottom.has_value(), runs);
  PassResult result;
  result.touches = curve.touches();
  mill::FitOptions fit{layout.step, o.accuracy.unit, plan.z0, plan.band, o.accuracy.arc_error, 0, o.accuracy.least_arc_radius};
  if (o.accuracy.arcs && layout.is_along_axis()) fit.most_radius = 64 * (plan.radius + cutter.drop.terrain().extent());
  const PassMoves in_space(layout, plan, o);
  for (const CurveRun& run : runs) {
    std::vector<FittedMove> moves;
    const LatticePoint start = CurveFit(run, fit).run(moves);
    result.cuts.push_back(in_space.cut(pass, start, moves));
    result.points += run.size();
  }
  return result;
}

constexpr int rounds_along = 5, most_rounds = 12;  // of passes between others, then across them

/// The passes of a layout as cuts, and further ones where the scallop is not proven to be kept.
class ParallelPasses {
 public:
  ParallelPasses(const DropCutter& drop, const Plan& plan, const mill::PassLayout& layout, const ParallelOptions& o,
                 MillReport& report, const Context& context)
      : drop_(drop),
        cutter_(drop, plan.lift),
        plan_(plan),
        o_(o),
        layout_(layout),
        report_(report),
        context_(context),
        limits_{mill::Boundary(o.boundary, drop.terrain().origin()), o.shallow * std::numbers::pi / 180,
                plan.step_over} {
    quiet_.threads = context.threads, quiet_.cancel = context.cancel;
    for (const mill::PassLayout::Pass& pass : layout.passes)
      passes_.push_back({2 * passes_.size() + 1, pass, &layout, {}});
  }

  const mill::PassLimits& limits() const { return limits_; }

  Result<std::vector<Cut>> run() {
    if (!make_cuts(0, context_)) return mill::cancelled();
    if (o_.scallop != 0)
      if (Status proven = prove(); !proven) return proven.error();
    return in_order();
  }

 private:
  struct Placed {
    std::size_t gap;  // 2 k + 1 for pass k of the layout, 2 k for those of the gap before it
    mill::PassLayout::Pass pass;
    const mill::PassLayout* layout;
    PassResult result;
  };
  bool make_cuts(std::size_t first, const Context& context) {
    kernel::Progress progress(context, passes_.size() - first);
    return kernel::parallel_blocks(context, passes_.size() - first, 1, [&](std::size_t k, std::size_t) {
      Placed& p = passes_[first + k];
      const bool is_fine = p.layout != &layout_;
      p.result = make_pass(cutter_, *p.layout, p.pass, is_fine ? *fine_plan_ : plan_, limits_, is_fine ? fine_ : o_);
      progress.add(1);
    });
  }

  /// At the bottom of a sharp valley a path is much higher above the ball's lowest place than it is away from the
  /// sides: passes that go there are more exact.
  Status make_fine_plan() {
    fine_ = o_;
    fine_.accuracy.tolerance = std::max(16 * o_.accuracy.unit + 2 * o_.accuracy.arc_error, o_.accuracy.tolerance / 8);
    Result<Plan> plan = mill::make_plan(drop_.terrain(), fine_, mill::Cutters::all);
    if (!plan) return plan.error();
    fine_plan_ = *plan;
    fine_plan_->band -= layout_.step;
    return std::monostate{};
  }

  Status prove() {
    if (Status made = make_fine_plan(); !made) return made;
    // What a ball enters that is a few units larger: a path keeps some away.
    const double room = 4 * o_.accuracy.unit;
    const Result<DropCutter> contact = drop_.with_radius(o_.tool.radius + o_.tool.allowance + room);
    if (!contact) return contact.error();
    const mill::CoverOptions cover{o_.tool.radius, o_.tool.allowance + room, o_.scallop - room, o_.scallop / 64, true};
    mill::CoverProof proof(*contact, cover);
    gaps_.emplace(layout_, plan_.step_over / 2, 2 * proof.smallest_side());
    const mill::Interest interest(*contact, limits_, plan_.step_over / 4);
    // Over its lowest places the ball rests a bit lower than the path.
    const double floor = plan_.floor - o_.accuracy.tolerance;
    const auto is_of_interest = [&interest, floor](Point3 p, double within) {
      return p.z + within > floor && (interest.is_everywhere() || interest.has({p.x, p.y}, within));
    };
    std::vector<std::size_t> tiles = proof.all_tiles(), open_tiles;
    std::vector<Point3> open;
    std::size_t proven = 0;
    for (int round = 1;; ++round) {
      for (; proven < passes_.size(); ++proven)
        for (const Cut& cut : passes_[proven].result.cuts) proof.add(cut);
      if (!proof.run(tiles, is_of_interest, quiet_, open, open_tiles)) return mill::cancelled();
      if (open.empty() || round > most_rounds) break;
      const std::vector<mill::PassGaps::Extra> extra =
          round <= rounds_along ? gaps_->serve(open, *contact) : gaps_->serve_across(open);
      for (const mill::PassGaps::Extra& e : extra)
        passes_.push_back({2 * e.gap, e.pass, e.is_across ? &gaps_->across() : &layout_, {}});
      if (!make_cuts(proven, quiet_)) return mill::cancelled();
      tiles = open_tiles;
    }
    if (!open.empty() && !add_plunges({drop_, *contact, cover, plan_, o_.accuracy.unit}, open_tiles, is_of_interest, open))
      return mill::cancelled();
    report_.open_places = open.size();
    report_.extra_passes = passes_.size() - layout_.passes.size();
    return std::monostate{};
  }

  /// What is of interest is farther from the boundary than these are from it.
  bool add_plunges(const mill::Plunges& plunges, const std::vector<std::size_t>& tiles,
                   const std::function<bool(Point3, double)>& is_of_interest, std::vector<Point3>& open) {
    std::vector<Cut> cuts;
    const auto add_cuts = [this](mill::CoverProof& proof) {
      for (const Placed& placed : passes_)
        for (const Cut& cut : placed.result.cuts) proof.add(cut);
    };
    if (!plunges.serve(add_cuts, tiles, is_of_interest, quiet_, cuts, open)) return false;
    for (Cut& cut : cuts) {
      const mill::PassGaps::Extra at = gaps_->at(vectors::operator-(cut.start, drop_.terrain().origin()));
      passes_.push_back({2 * at.gap, at.pass, &layout_, {}});
      passes_.back().result.cuts.push_back(std::move(cut));
    }
    return true;
  }

  /// Pass by pass, and the pieces of each gap on the way back, whatever line they are on.
  std::vector<Cut> in_order() {
    std::stable_sort(passes_.begin(), passes_.end(), [](const Placed& a, const Placed& b) { return a.gap < b.gap; });
    std::vector<Cut> cuts;
    bool backwards = false;
    for (std::size_t k = 0; k < passes_.size();) {
      std::size_t end = k + 1;
      while (end < passes_.size() && passes_[end].gap == passes_[k].gap) ++end;
      const auto first = passes_.begin() + std::ptrdiff_t(k), last = passes_.begin() + std::ptrdiff_t(end);
      std::stable_sort(first, last, [backwards](const Placed& a, const Placed& b) {
        return backwards ? a.pass.last > b.pass.last : a.pass.first < b.pass.first;
      });
      for (; k < end; ++k) append(passes_[k], backwards, cuts);
      backwards = o_.zigzag && !backwards;
    }
    return cuts;
  }

  void append(Placed& placed, bool backwards, std::vector<Cut>& cuts) {
    report_.curve_points += placed.result.points, report_.touches += placed.result.touches;
    std::vector<Cut>& made = placed.result.cuts;
    if (backwards) {
      std::reverse(made.begin(), made.end());
      for (Cut& cut : made) mill::reverse(cut);
    }
    for (Cut& cut : made) cuts.push_back(std::move(cut));
  }

  const DropCutter& drop_;
  mill::LiftedCutter cutter_;
  const Plan& plan_;
  const ParallelOptions& o_;
  ParallelOptions fine_;
  std::optional<Plan> fine_plan_;
  const mill::PassLayout& layout_;
  MillReport& report_;
  const Context& context_;
  Context quiet_;
  mill::PassLimits limits_;
  std::optional<mill::PassGaps> gaps_;
  std::vector<Placed> passes_;
};

}  // namespace

Result<MilledPath> mill_parallel(std::shared_ptr<const Terrain> part, const ParallelOptions& o,
                                 const Context& context) {
  Result<Plan> made = mill::make_plan(*part, o, mill::Cutters::all);
  if (!made) return made.error();
  Plan& plan = *made;
  const Result<DropCutter> drop = DropCutter::build(part, plan.cutter, context);
  if (!drop) return drop.error();
  const mill::PassLayout layout =
      mill::lay_passes(*part, o.accuracy.unit, o.angle, plan.step_over, plan.radius, o.accuracy.tolerance);
  plan.band -= layout.step;
  MilledPath milled;
  ParallelPasses passes(*drop, plan, layout, o, milled.report, context);
  Result<std::vector<Cut>> cuts = passes.run();
  if (!cuts) return cuts.error();
  if (cuts->empty())
    return Error{
        ErrorCode::input, "there is no pass over the part", "",
        o.boundary.polygons.empty() ? "use a smaller step-over" : "use a smaller step-over or a larger boundary"};
  milled.report.passes = layout.passes.size() + milled.report.extra_passes, milled.report.cuts = cuts->size();
  milled.report.step_over = layout.step_over, milled.report.angle = layout.angle();
  const double short_link = o.zigzag ? 1.5 * plan.step_over : 0;
  mill::LinkOptions links = mill::links_of(plan, o.tool, o.accuracy, o.motion, o.motion.feed, short_link);
  links.boundary = &passes.limits().boundary;
  return mill::finish_path({*drop, plan.lift}, std::move(*cuts), links, o.motion, std::move(milled), context);
}

}  // namespace krepl
