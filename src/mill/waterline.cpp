#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "kernel/parallel.hpp"
#include "krepl/drop_cutter.hpp"
#include "krepl/mill.hpp"
#include "krepl/section.hpp"
#include "mill/boundary.hpp"
#include "mill/flat_fit.hpp"
#include "mill/free_moves.hpp"
#include "mill/grown_cutter.hpp"
#include "mill/level_lines.hpp"
#include "mill/level_set.hpp"
#include "mill/links.hpp"
#include "mill/plan.hpp"
#include "model/radius_check.hpp"

namespace krepl {
namespace {

using mill::Band;
using mill::Cut;
using mill::FlatMove;
using mill::FlatPoint;
using mill::LevelLine;
using mill::LevelRing;
using mill::Plan;

constexpr std::size_t levels_at_once = 64;

Status check(const WaterlineOptions& o) {
  if (Status checked = mill::check_boundary(o.boundary); !checked) return checked.error();
  if (!mill::is_positive(o.step_down))
    return mill::usage("the step down is not a finite number greater than zero", "give one in the unit of the part");
  if (!(o.steep >= 0 && o.steep < 90)) return mill::usage("the steep angle is not between 0 and 90 degrees", "");
  return std::monostate{};
}

/// Heights of levels in units, from below the top down.
Result<std::vector<std::int64_t>> level_heights(const Terrain& part, const Plan& plan, const Band& band,
                                                const WaterlineOptions& o) {
  const double unit = o.accuracy.unit;
  // Of the control point above the ground on which the cutter that curves are those of rests.
  const double above = plan.lift == 0 ? band.curve_radius : o.tool.allowance + band.curve_room;
  const auto top = std::int64_t(std::floor((part.highest().z + above - plan.z0) / unit));
  // Without a bottom the ball rests on the lowest ground there.
  const auto bottom = o.bottom ? std::int64_t(std::ceil((plan.floor - plan.z0) / unit))
                               : std::int64_t(std::floor((part.lowest().z + above - plan.z0) / unit)) + 1;
  if (bottom >= top) return mill::usage("the lowest level is not below the part's top", "");
  auto heights = mill::spread_levels(top, bottom, unit, o.step_down);
  if (heights) heights->erase(heights->begin());  // nothing is above the top
  return heights;
}

/// Polylines on levels, as cuts.
class LevelCuts {
 public:
  LevelCuts(const Terrain& part, const Band& band, const Plan& plan, const WaterlineOptions& o) : plan_(plan), o_(o) {
    fit_.lattice = {o.accuracy.unit, part.origin()};
    fit_.within = band.within * 3 / 4;  // the rest is for the polyline
    if (o.accuracy.arcs) fit_.most_radius = 64 * (plan.radius + part.extent());
    fit_.least_radius = o.accuracy.least_arc_radius;
  }

  Cut make(const LevelLine& line, std::int64_t k) const {
    std::vector<FlatMove> moves;
    const FlatPoint start = mill::FlatFit(line, fit_).run(moves);
    Cut cut;
    cut.start = place(start, k);
    for (const FlatMove& m : moves) {
      Move move{MoveKind::line, ArcPlane::xy, place(m.end, k), {}, o_.motion.feed};
      if (m.turn != 0) {
        move.kind = m.turn > 0 ? MoveKind::counter_clockwise : MoveKind::clockwise;
        move.centre = place(m.centre, k);
      }
      cut.moves.push_back(move);
    }
    return cut;
  }

 private:
  Point3 place(FlatPoint p, std::int64_t k) const {
    const double unit = o_.accuracy.unit;
    return {double(p.i) * unit, double(p.j) * unit, double(k) * unit + plan_.tip};
  }

  const Plan& plan_;
  const WaterlineOptions& o_;
  mill::FlatFitOptions fit_;
};

/// Contours of levels as rings, relative to the part's origin.
class LevelSource {
 public:
  virtual ~LevelSource() = default;
  virtual Result<std::vector<std::vector<LevelRing>>> rings(const std::vector<double>& levels,
                                                            const Context& context) const = 0;
};

/// Of the exact surface of a ball.
class SurfaceLevels final : public LevelSource {
 public:
  SurfaceLevels(SurfaceCutter sections, const mill::LevelLineOptions& along) : sections_(std::move(sections)), along_(along) {}
  Result<std::vector<std::vector<LevelRing>>> rings(const std::vector<double>& levels,
                                                    const Context& context) const override {
    ContourOptions ties;
    ties.ties_are_high = false;  // the ball may rest on level ground
    const auto contours = sections_.contours(levels, ties, context);
    if (!contours) return contours.error();
    std::vector<std::vector<LevelRing>> rings;
    for (const Contour& contour : *contours) rings.push_back(mill::level_rings(contour, sections_.surface(), along_));
    return rings;
  }

 private:
  SurfaceCutter sections_;
  mill::LevelLineOptions along_;
};

/// Of any other cutter.
class TracedLevels final : public LevelSource {
 public:
  TracedLevels(DropCutter cutter, double lift, const mill::LevelSetOptions& options)
      : cutter_(std::move(cutter)), lift_(lift), options_(options) {}
  Result<std::vector<std::vector<LevelRing>>> rings(const std::vector<double>& levels,
                                                    const Context& context) const override {
    std::vector<std::vector<LevelRing>> rings(levels.size());
    std::vector<char> traced(levels.size());
    const bool done = kernel::parallel_blocks(context, levels.size(), 1, [&](std::size_t n, std::size_t) {
      traced[n] = mill::trace_level_set({cutter_, lift_}, levels[n], options_, context, rings[n]);
    });
    if (!done) return mill::cancelled();
    for (std::size_t n = 0; n < levels.size(); ++n)
      if (!traced[n])
        return Error{ErrorCode::computation, "the contour of level " + shown(levels[n]) + " cannot be traced", "",
                     "use another step down, or more decimals"};
    return rings;
  }

 private:
  DropCutter cutter_;
  double lift_;
  mill::LevelSetOptions options_;
};

/// Cuts along all contours, in order.
class WaterlineCuts {
 public:
  WaterlineCuts(const mill::LiftedCutter& prover, const LevelSource& source, const Band& band, const Plan& plan,
                const mill::Boundary& boundary, const WaterlineOptions& o, MillReport& report)
      : prover_(prover),
        source_(source),
        band_(band),
        plan_(plan),
        boundary_(boundary),
        o_(o),
        report_(report),
        shape_(prover.drop.terrain(), band, plan, o),
        at_{prover.drop.terrain().lowest().x, prover.drop.terrain().lowest().y} {}

  /// Adds those of some levels.
  Status add(std::span<const std::int64_t> heights, const Context& context) {
    std::vector<double> levels;
    for (const std::int64_t k : heights) levels.push_back(plan_.z0 + double(k) * o_.accuracy.unit);
    auto rings = source_.rings(levels, context);
    if (!rings) return rings.error();
    std::vector<LevelLine> lines;
    std::vector<std::int64_t> line_heights;
    for (std::size_t n = 0; n < heights.size(); ++n)
      for (const LevelLine& ring : mill::level_lines(std::move((*rings)[n]), at_, report_.skipped_cuts))
        for (LevelLine& line : boundary_.inside(ring)) {
          report_.curve_points += line.size();
          lines.push_back(std::move(line)), line_heights.push_back(heights[n]);
        }
    const std::size_t begin = cuts.size();
    cuts.resize(begin + lines.size());
    std::vector<std::size_t> lifted(lines.size());
    const bool done = kernel::parallel_blocks(context, lines.size(), 1, [&](std::size_t k, std::size_t) {
      mill::FreeMoves free(prover_, band_, plan_, o_.accuracy.unit);
      cuts[begin + k] = shape_.make(lines[k], line_heights[k]);
      lifted[k] = free.settle(cuts[begin + k], o_.motion.plunge_feed);
    });
    if (!done) return mill::cancelled();
    for (const std::size_t n : lifted) report_.lifted_moves += n;
    return std::monostate{};
  }

  std::vector<Cut> cuts;

 private:
  const mill::LiftedCutter& prover_;
  const LevelSource& source_;
  const Band& band_;
  const Plan& plan_;
  const mill::Boundary& boundary_;
  const WaterlineOptions& o_;
  MillReport& report_;
  LevelCuts shape_;
  Point at_;
};

Result<std::unique_ptr<LevelSource>> make_source(const std::shared_ptr<const Terrain>& part, const DropCutter& cutter,
                                                 const Plan& plan, const Band& band, const WaterlineOptions& o,
                                                 const Context& context) {
  const double unit = o.accuracy.unit, steep = o.steep * std::numbers::pi / 180;
  if (plan.lift == 0) {
    Result<Surface> surface = compute_surface(part, {band.curve_radius}, context);
    if (!surface) return surface.error();
    auto sections = SurfaceCutter::build(std::make_shared<const Surface>(std::move(*surface)), context);
    if (!sections) return sections.error();
    const mill::LevelLineOptions along{band.within / 8, unit / 4, o.climb, steep};
    return std::unique_ptr<LevelSource>(std::make_unique<SurfaceLevels>(std::move(*sections), along));
  }
  const Result<Cutter> larger = mill::grow(*o.tool.cutter, o.tool.allowance, band.curve_room);
  if (!larger) return larger.error();
  Result<DropCutter> drop = cutter.with_cutter(*larger);
  if (!drop) return drop.error();
  const mill::LevelSetOptions along{band.within / 8, unit / 1024, plan.radius / 4, steep, o.climb};
  return std::unique_ptr<LevelSource>(
      std::make_unique<TracedLevels>(std::move(*drop), o.tool.allowance + band.curve_room, along));
}

Result<std::vector<Cut>> cut_levels(const std::shared_ptr<const Terrain>& part, const DropCutter& cutter,
                                    std::span<const std::int64_t> heights, const Plan& plan, const Band& band,
                                    const mill::Boundary& boundary, const WaterlineOptions& o, MillReport& report,
                                    const Context& context) {
  const Result<DropCutter> prover = mill::make_prover(cutter, plan, band, o.tool);
  if (!prover) return prover.error();
  const auto source = make_source(part, cutter, plan, band, o, context);
  if (!source) return source.error();
  const mill::LiftedCutter lifted(*prover, mill::prover_lift(plan, band, o.tool));
  WaterlineCuts waterlines(lifted, **source, band, plan, boundary, o, report);
  Context quiet;
  quiet.threads = context.threads, quiet.cancel = context.cancel;
  kernel::Progress progress(context, heights.size());
  for (std::size_t first = 0; first < heights.size(); first += levels_at_once) {
    const std::size_t count = std::min(levels_at_once, heights.size() - first);
    if (Status added = waterlines.add(heights.subspan(first, count), quiet); !added) return added.error();
    progress.add(count);
  }
  std::erase_if(waterlines.cuts, [](const Cut& c) { return c.moves.empty(); });
  return std::move(waterlines.cuts);
}

}  // namespace

Result<MilledPath> mill_waterline(std::shared_ptr<const Terrain> part, const WaterlineOptions& o,
                                  const Context& context) {
  if (Status checked = check(o); !checked) return checked.error();
  const Result<Plan> plan = mill::make_plan(*part, o.tool, o.accuracy, o.motion, o.bottom, mill::Cutters::all);
  if (!plan) return plan.error();
  const double farther = plan->lift == 0 ? 1 : mill::roundness(*o.tool.cutter, o.tool.allowance);
  const Band band = mill::make_band(*plan, o.accuracy, farther);
  const auto heights = level_heights(*part, *plan, band, o);
  if (!heights) return heights.error();
  const Result<DropCutter> cutter = DropCutter::build(part, plan->cutter, context);
  if (!cutter) return cutter.error();
  MilledPath milled;
  const mill::Boundary boundary(o.boundary, part->origin());
  Result<std::vector<Cut>> cuts = cut_levels(part, *cutter, *heights, *plan, band, boundary, o, milled.report, context);
  if (!cuts) return cuts.error();
  if (cuts->empty())
    return Error{ErrorCode::input, "there is no place to cut on any level", "",
                 o.boundary.polygons.empty() ? "use a smaller step down or steep angle"
                                             : "use a smaller step down or steep angle, or a larger boundary"};
  milled.report.levels = heights->size(), milled.report.passes = milled.report.cuts = cuts->size();
  // Links have the plunge feed: they come down to what is not yet cut.
  auto links = mill::links_of(*plan, o.tool, o.accuracy, o.motion, o.motion.plunge_feed, mill::radius_of(o.tool));
  links.floor = plan->z0 + double(heights->back()) * o.accuracy.unit;
  links.boundary = &boundary;
  return mill::finish_path({*cutter, plan->lift}, std::move(*cuts), links, o.motion, std::move(milled), context);
}

}  // namespace krepl
