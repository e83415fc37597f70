#include "mill/scallop_passes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "kernel/parallel.hpp"
#include "kernel/vectors.hpp"
#include "krepl/surface.hpp"
#include "mill/cover_proof.hpp"
#include "mill/cut_order.hpp"
#include "mill/free_moves.hpp"
#include "mill/grid_lines.hpp"
#include "mill/on_surface.hpp"
#include "mill/plunges.hpp"
#include "mill/rest_area.hpp"
#include "mill/space_fit.hpp"
#include "mill/surface_grid.hpp"
#include "mill/valleys.hpp"
#include "model/radius_check.hpp"

namespace krepl::mill {

using namespace vectors;

namespace {

using Index = SurfaceGrid::Index;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double most_places = 0x1p24;
constexpr double part_of_reach = 0.9;  // half the distance of passes, of what a plane allows
constexpr int halvings = 6, touches = 4;  // rounds of lines between others, then of short ones

class ScallopPasses {
 public:
  ScallopPasses(const DropCutter& cutter, const Plan& plan, const Band& band, const ScallopJob& job, MillReport& report,
                const Context& context)
      : plan_(plan), band_(band), job_(job), report_(report), contact_(cutter), curve_(cutter) {
    quiet_.threads = context.threads, quiet_.cancel = context.cancel;
    // On a plane, with passes as high as the tolerance allows.
    const double r = job.tool.radius, core = r - job.scallop + job.accuracy.tolerance;
    half_ = part_of_reach * std::sqrt(r * r - core * core);
  }

  Status run(const std::shared_ptr<const Terrain>& part, std::vector<Cut>& cuts) {
    if (Status made = make_tools(); !made) return made;
    const Result<Surface> surface = compute_surface(part, {band_.curve_radius}, quiet_);
    if (!surface) return surface.error();
    Valleys valleys;
    const ValleyOptions sharp{band_.within / 8, job_.valley_angle * std::numbers::pi / 180, 4 * job_.accuracy.unit};
    if (!find_valleys(*surface, *foot_, sharp, quiet_, valleys)) return cancelled();
    if (Status laid = lay_field(valleys.chains, border_of(*surface)); !laid) return laid;
    std::vector<SpaceLine> lines = in_cells(valleys.chains);
    for (SpaceLine& line : lines_at(2 * half_, 2 * half_, cells_)) lines.push_back(std::move(line));
    if (!add(lines, *usual_, cuts)) return cancelled();
    report_.passes = cuts.size();
    if (cuts.empty()) return std::monostate{};
    return prove(cuts);
  }

 private:
  /// How exactly lines are followed.
  struct Following {
    Band band;
    DropCutter curve, prover;
  };

  Status make_following(double tolerance, std::optional<Following>& made) const {
    MillAccuracy accuracy = job_.accuracy;
    accuracy.tolerance = tolerance;
    const Band band = make_band(plan_, accuracy);
    const Result<DropCutter> curve = contact_.with_radius(band.curve_radius), prover = contact_.with_radius(band.proof_radius);
    if (!curve) return curve.error();
    if (!prover) return prover.error();
    made.emplace(Following{band, *curve, *prover});
    return std::monostate{};
  }

  Status make_tools() {
    const double least = 16 * job_.accuracy.unit + 2 * job_.accuracy.arc_error, tolerance = job_.accuracy.tolerance;
    if (Status s = make_following(tolerance, usual_); !s) return s;
    // At the bottom of a sharp valley a path is much higher above the ball's lowest place than it is away from the sides.
    if (Status s = make_following(std::max(least, tolerance / 8), fine_); !s) return s;
    const auto make = [&](DropCutter& cutter, double radius) -> Status {
      Result<DropCutter> made = contact_.with_radius(radius);
      if (!made) return made.error();
      cutter = *made;
      return std::monostate{};
    };
    DropCutter foot = contact_;
    if (Status s = make(foot, band_.curve_radius - job_.accuracy.unit / 2); !s) return s;
    foot_.emplace(foot);
    if (Status s = make(curve_, band_.curve_radius); !s) return s;
    return make(contact_, job_.tool.radius + job_.tool.allowance + 4 * job_.accuracy.unit);
  }

  /// The raster, and distances from valleys and the border, which counts as half-way between passes.
  Status lay_field(const std::vector<SpaceLine>& chains, const std::vector<SpaceLine>& border) {
    const double step = half_ / 4;
    if (SurfaceGrid::count(curve_, step) > most_places)
      return usage("the scallop height " + shown(job_.scallop) + " means a raster of more than 16 million places",
                   "use a larger one");
    if (!grid_.build(curve_, {step, job_.tool.radius, job_.scallop}, quiet_)) return cancelled();
    field_.assign(grid_.size(), infinity);
    for (const auto* lines : {&chains, &border})
      for (const SpaceLine& line : *lines)
        for (std::size_t k = 1; k < line.size(); ++k) start_from(line[k - 1], line[k], lines == &border ? half_ : 0);
    grid_.spread(field_);
    if (job_.after == 0) return std::monostate{};
    std::vector<char> rest;
    if (!find_rest(grid_, curve_, {job_.after, job_.tool.allowance, job_.threshold}, quiet_, rest)) return cancelled();
    cells_.assign(grid_.size(), 0);
    for (std::size_t v = 0; v < grid_.size(); ++v)
      if (rest[v]) mark(grid_.place(Index(v)), 1.5 * grid_.step(), cells_);
    return std::monostate{};
  }

  /// Where the surface ends and the ball touches nothing beyond.
  std::vector<SpaceLine> border_of(const Surface& surface) const {
    std::vector<SpaceLine> border;
    for (Surface::Index e = 0; e < surface.subdivision().half_edge_count() / 2; ++e) {
      if (surface.edge(e).kind != Surface::EdgeKind::rim) continue;
      SpaceLine points = surface.curve(e, 17);
      const Point3 middle = points[8];
      if (!foot_->at({middle.x, middle.y}).touches()) border.push_back(std::move(points));
    }
    return border;
  }

  void start_from(Point3 a, Point3 b, double value) {
    const double count = std::max(1.0, std::ceil(std::hypot(b.x - a.x, b.y - a.y) / (grid_.step() / 2)));
    for (double n = 0; n <= count; ++n) {
      const Point3 p = a + (n / count) * (b - a);
      const Index v = grid_.cell_of(p.x, p.y);
      if (v == SurfaceGrid::none) continue;
      const Index across = Index(grid_.columns());
      for (const Index w : {v, v + 1, v + across, v + across + 1})
        if (grid_.touches(w)) field_[w] = std::min(field_[w], value + grid_.distance_to(w, p));
    }
  }

  /// Marks cells that are within a distance of a place.
  void mark(Point p, double far, std::vector<char>& cells) const {
    const double step = grid_.step();
    for (double x = p.x - far; x < p.x + far + step; x += step)
      for (double y = p.y - far; y < p.y + far + step; y += step)
        if (const Index v = grid_.cell_of(std::min(x, p.x + far), std::min(y, p.y + far)); v != SurfaceGrid::none)
          cells[v] = 1;
  }

  /// The parts of lines that are in marked cells.
  std::vector<SpaceLine> in_cells(const std::vector<SpaceLine>& lines) const {
    if (cells_.empty()) return lines;
    std::vector<SpaceLine> parts;
    for (const SpaceLine& line : lines) {
      SpaceLine part;
      for (std::size_t k = 0; k < line.size(); ++k) {
        const Index v = grid_.cell_of(line[k].x, line[k].y);
        if (v != SurfaceGrid::none && cells_[v]) {
          part.push_back(line[k]);
        } else {
          if (part.size() > 1) parts.push_back(part);
          part.clear();
        }
      }
      if (part.size() > 1) parts.push_back(part);
    }
    return parts;
  }

  std::vector<SpaceLine> lines_at(double first, double step, const std::vector<char>& cells) const {
    return grid_lines(grid_, field_, {first, step, cells.empty() ? nullptr : &cells});
  }

  /// Short lines through places, one for all that are near each other: where the lines between others do not get.
  std::vector<SpaceLine> short_lines(const std::vector<Point3>& places) const {
    const double size = half_ / 4, least = 4 * job_.accuracy.unit;
    std::map<std::array<std::int64_t, 3>, SpaceLine> lines;
    for (const Point3 p : places) {
      SpaceLine& line = lines[{std::int64_t(std::floor(p.x / size)), std::int64_t(std::floor(p.y / size)),
                               std::int64_t(std::floor(p.z / size))}];
      if (line.empty())
        line = {p, p};
      else if (distance(line.front(), p) > distance(line.front(), line.back()))
        line.back() = p;
    }
    std::vector<SpaceLine> found;
    for (auto& [key, line] : lines) {
      if (distance(line.front(), line.back()) < least) line.back().z += least;
      found.push_back(std::move(line));
    }
    return found;
  }

  /// Cuts along lines, put onto the surface.
  bool add(const std::vector<SpaceLine>& lines, const Following& f, std::vector<Cut>& cuts) {
    const double unit = job_.accuracy.unit;
    const Point3 origin = curve_.terrain().origin();
    const SpaceLattice lattice{unit, {-origin.x, -origin.y, plan_.z0}};
    std::vector<std::vector<Cut>> made(lines.size());
    std::vector<std::size_t> lifted(lines.size()), points(lines.size());
    const bool done = kernel::parallel_blocks(quiet_, lines.size(), 4, [&](std::size_t first, std::size_t last) {
      const OnSurface surface(f.curve, f.band.within / 8, 8 * unit);
      FreeMoves free(f.prover, f.band, plan_, unit);
      for (std::size_t k = first; k < last; ++k)
        for (const SpaceLine& line : surface.put(lines[k])) {
          points[k] += line.size();
          Cut cut = lines_cut(line, lattice, f.band.within);
          lifted[k] += free.settle(cut, job_.motion.plunge_feed);
          if (!cut.moves.empty()) made[k].push_back(std::move(cut));
        }
    });
    for (std::size_t k = 0; k < lines.size(); ++k) {
      report_.lifted_moves += lifted[k], report_.curve_points += points[k];
      for (Cut& cut : made[k]) cuts.push_back(std::move(cut));
    }
    return done;
  }

  Cut lines_cut(const SpaceLine& line, const SpaceLattice& lattice, double within) const {
    Cut cut;
    bool first = true;
    // A quarter is for the polyline.
    for (const SpaceLattice::Place& p : fit_lines(line, lattice, within * 3 / 4)) {
      const Point3 at{double(p[0]) * lattice.unit, double(p[1]) * lattice.unit, double(p[2]) * lattice.unit + plan_.tip};
      if (first)
        cut.start = at;
      else
        cut.moves.push_back({MoveKind::line, ArcPlane::xy, at, {}, job_.motion.feed});
      first = false;
    }
    return cut;
  }

  /// Proves that the cuts keep the scallop; adds lines half-way between others near places where that fails, and so on.
  Status prove(std::vector<Cut>& cuts) {
    // What a ball enters that is a few units larger: a path keeps some away.
    const double room = 4 * job_.accuracy.unit;
    const CoverOptions cover{job_.tool.radius, job_.tool.allowance + room, job_.scallop - room, 0, true};
    CoverProof proof(contact_, cover);
    std::function<bool(Point3, double)> is_of_interest;
    if (!cells_.empty())
      is_of_interest = [this](Point3 p, double far) {
        const double step = grid_.step();
        for (double x = p.x - far; x < p.x + far + step; x += step)
          for (double y = p.y - far; y < p.y + far + step; y += step) {
            const Index v = grid_.cell_of(std::min(x, p.x + far), std::min(y, p.y + far));
            if (v != SurfaceGrid::none && cells_[v]) return true;
          }
        return false;
      };
    std::vector<std::size_t> tiles = proof.all_tiles(), open_tiles;
    std::vector<Point3> open;
    std::size_t proven = 0;
    for (int n = 1;; ++n) {
      for (; proven < cuts.size(); ++proven) proof.add(cuts[proven]);
      if (!proof.run(tiles, is_of_interest, quiet_, open, open_tiles)) return cancelled();
      if (open.empty() || n > halvings + touches) break;
      if (n > halvings) {
        if (!add(short_lines(open), *fine_, cuts)) return cancelled();
      } else {
        std::vector<char> near(grid_.size(), 0);
        for (const Point3 p : open) mark({p.x, p.y}, half_, near);
        for (std::size_t v = 0; v < cells_.size(); ++v) near[v] &= cells_[v];
        const double step = 2 * half_ / std::ldexp(1.0, n - 1);
        if (!add(lines_at(step / 2, step, near), *usual_, cuts)) return cancelled();
      }
      tiles = open_tiles;
    }
    if (!open.empty()) {
      const Result<DropCutter> cutter = contact_.with_radius(plan_.radius);
      if (!cutter) return cutter.error();
      const auto add_cuts = [&cuts](CoverProof& finer) {
        for (const Cut& cut : cuts) finer.add(cut);
      };
      std::vector<Cut> plunges;
      if (!Plunges(*cutter, contact_, cover, plan_, job_.accuracy.unit)
               .serve(add_cuts, open_tiles, is_of_interest, quiet_, plunges, open))
        return cancelled();
      for (Cut& cut : plunges) cuts.push_back(std::move(cut));
    }
    report_.open_places = open.size();
    report_.extra_passes = cuts.size() - report_.passes;
    return std::monostate{};
  }

  const Plan& plan_;
  const Band& band_;
  const ScallopJob& job_;
  MillReport& report_;
  Context quiet_;
  DropCutter contact_, curve_;  // with what scallops are told; of curves
  std::optional<DropCutter> foot_;
  std::optional<Following> usual_, fine_;
  double half_;
  SurfaceGrid grid_;
  std::vector<double> field_;
  std::vector<char> cells_;  // of the raster, where there is something to do; empty: everywhere
};

}  // namespace

Status check(const ScallopJob& job) {
  if (!is_positive(job.scallop) || !(job.scallop <= job.tool.radius / 2))
    return usage("the scallop height is not between 0 and half the tool's radius", "");
  if (job.scallop < 2 * job.accuracy.tolerance)
    return usage("the scallop height " + shown(job.scallop) + " leaves no room for the tolerance " + shown(job.accuracy.tolerance),
                 "use a tolerance of at most " + shown(job.scallop / 2));
  if (!(job.valley_angle >= 0 && job.valley_angle < 180))
    return usage("the valleys' angle is not between 0 and 180 degrees", "");
  return std::monostate{};
}

Result<std::vector<Cut>> scallop_cuts(const std::shared_ptr<const Terrain>& part, const DropCutter& cutter, const Plan& plan,
                                      const ScallopJob& job, MillReport& report, const Context& context) {
  const Band band = make_band(plan, job.accuracy);
  std::vector<Cut> cuts;
  if (Status made = ScallopPasses(cutter, plan, band, job, report, context).run(part, cuts); !made) return made.error();
  order_cuts(cuts);
  return cuts;
}

}  // namespace krepl::mill
