#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "kernel/parallel.hpp"
#include "krepl/drop_cutter.hpp"
#include "krepl/mill.hpp"
#include "krepl/surface.hpp"
#include "mill/free_moves.hpp"
#include "mill/links.hpp"
#include "mill/plan.hpp"
#include "mill/space_fit.hpp"
#include "mill/valleys.hpp"

namespace krepl {
namespace {

using mill::Cut;
using mill::Plan;

using Chain = std::vector<Point3>;

constexpr std::size_t most_sorted = 4000;

Status check(const PencilOptions& o) {
  if (!(o.valley_angle >= 0 && o.valley_angle < 180))
    return mill::usage("the valleys' angle is not between 0 and 180 degrees", "");
  if (std::isnan(o.shortest)) return mill::usage("the shortest valley's length is not a number", "");
  return std::monostate{};
}

/// Each chain from its end that is nearer to the end of the one before, the nearest next.
void sort_chains(std::vector<Chain>& chains) {
  if (chains.empty() || chains.size() > most_sorted) return;
  const auto off = [](Point3 a, Point3 b) { return std::hypot(a.x - b.x, a.y - b.y); };
  Point3 at = chains.front().front();
  for (std::size_t k = 0; k < chains.size(); ++k) {
    std::size_t best = k;
    double nearest = -1;
    for (std::size_t n = k; n < chains.size(); ++n)
      if (const double d = std::min(off(at, chains[n].front()), off(at, chains[n].back())); nearest < 0 || d < nearest)
        best = n, nearest = d;
    std::swap(chains[k], chains[best]);
    if (off(at, chains[k].back()) < off(at, chains[k].front())) std::reverse(chains[k].begin(), chains[k].end());
    at = chains[k].back();
  }
}

Cut make_cut(const Chain& chain, const mill::SpaceLattice& lattice, double within, const Plan& plan, double feed) {
  Cut cut;
  bool first = true;
  for (const mill::SpaceLattice::Place& p : mill::fit_lines(chain, lattice, within)) {
    const Point3 at{double(p[0]) * lattice.unit, double(p[1]) * lattice.unit, double(p[2]) * lattice.unit + plan.tip};
    if (first)
      cut.start = at;
    else
      cut.moves.push_back({MoveKind::line, ArcPlane::xy, at, {}, feed});
    first = false;
  }
  return cut;
}

/// Cuts along the valleys, and what they need to be linked.
Result<std::vector<Cut>> cut_valleys(const std::shared_ptr<const Terrain>& part, const DropCutter& cutter,
                                     const Plan& plan, const PencilOptions& o, MillReport& report,
                                     const Context& context) {
  const double unit = o.accuracy.unit;
  const mill::Band band = mill::make_band(plan, o.accuracy);
  const Result<DropCutter> prover = cutter.with_radius(band.proof_radius);
  if (!prover) return prover.error();
  const Result<DropCutter> foot = cutter.with_radius(band.curve_radius - unit / 2);
  if (!foot) return foot.error();
  const Result<Surface> surface = compute_surface(part, {band.curve_radius}, context);
  if (!surface) return surface.error();
  Context quiet;
  quiet.threads = context.threads, quiet.cancel = context.cancel;
  mill::Valleys valleys;
  const double shortest = o.shortest < 0 ? o.tool.radius : o.shortest;
  if (!mill::find_valleys(*surface, *foot, {band.within / 8, o.valley_angle * std::numbers::pi / 180, shortest}, quiet,
                          valleys))
    return mill::cancelled();
  sort_chains(valleys.chains);
  report.skipped_cuts = valleys.too_short;
  const Point3 origin = part->origin();
  const mill::SpaceLattice lattice{unit, {-origin.x, -origin.y, plan.z0}};
  std::vector<Cut> cuts(valleys.chains.size());
  std::vector<std::size_t> lifted(cuts.size());
  kernel::Progress progress(context, cuts.size());
  const bool done = kernel::parallel_blocks(quiet, cuts.size(), 1, [&](std::size_t k, std::size_t) {
    mill::FreeMoves free(*prover, band, plan, unit);
    // A quarter is for the polyline, and for the smaller ball at the feet of walls.
    cuts[k] = make_cut(valleys.chains[k], lattice, band.within * 3 / 4, plan, o.motion.feed);
    lifted[k] = free.settle(cuts[k], o.motion.plunge_feed);
    progress.add(1);
  });
  if (!done) return mill::cancelled();
  for (const auto& chain : valleys.chains) report.curve_points += chain.size();
  for (const std::size_t n : lifted) report.lifted_moves += n;
  std::erase_if(cuts, [](const Cut& c) { return c.moves.empty(); });
  return cuts;
}

}  // namespace

Result<MilledPath> mill_pencil(std::shared_ptr<const Terrain> part, const PencilOptions& o, const Context& context) {
  if (Status checked = check(o); !checked) return checked.error();
  const Result<Plan> plan = mill::make_plan(*part, o.tool, o.accuracy, o.motion, {});
  if (!plan) return plan.error();
  const Result<DropCutter> cutter = DropCutter::build(part, plan->radius, context);
  if (!cutter) return cutter.error();
  MilledPath milled;
  Result<std::vector<Cut>> cuts = cut_valleys(part, *cutter, *plan, o, milled.report, context);
  if (!cuts) return cuts.error();
  if (cuts->empty())
    return Error{ErrorCode::input, "the surface has no valley so sharp and long", "",
                 "use a smaller angle or length, or a smaller tool"};
  milled.report.passes = milled.report.cuts = cuts->size();
  const auto links = mill::links_of(*plan, o.tool, o.accuracy, o.motion, o.motion.plunge_feed, o.tool.radius);
  return mill::finish_path(*cutter, std::move(*cuts), links, o.motion, std::move(milled), context);
}

}  // namespace krepl
