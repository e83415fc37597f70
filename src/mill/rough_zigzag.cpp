#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "kernel/parallel.hpp"
#include "mill/drive_curve.hpp"
#include "mill/pass_layout.hpp"
#include "mill/rough_job.hpp"

namespace krepl::mill {
namespace {

/// A stretch of a pass where the tool is at a level.
struct Stretch {
  std::size_t pass;
  std::int64_t first, last;
  bool done = false;
};

/// The whole of one level: what is cut there, pass by pass.
struct Level {
  std::int64_t k = 0;  // its height in units
  std::vector<std::vector<Stretch>> passes;
};

/// Where a curve is not above a level.
std::vector<Stretch> stretches_below(const CurveRun& run, double level, double step, std::size_t pass) {
  std::vector<Stretch> found;
  const auto crossing = [&](std::size_t v) {  // of the segment from v
    const double dt = run[v + 1].t - run[v].t, dz = run[v + 1].z - run[v].z;
    return run[v].t + dt * std::clamp((level - run[v].z) / dz, 0.0, 1.0);
  };
  for (std::size_t v = 0; v < run.size(); ++v) {
    if (run[v].z > level) continue;
    std::size_t end = v;
    while (end + 1 < run.size() && run[end + 1].z <= level) ++end;
    // Half a step less where the curve rises: rounding of the crossing.
    const double from = v == 0 ? run[v].t : crossing(v - 1) + step / 2;
    const double to = end + 1 == run.size() ? run[end].t : crossing(end) - step / 2;
    const std::int64_t first = v == 0 ? std::llround(from / step) : std::int64_t(std::ceil(from / step));
    const std::int64_t last = end + 1 == run.size() ? std::llround(to / step) : std::int64_t(std::floor(to / step));
    if (first < last) found.push_back({pass, first, last});
    v = end;
  }
  return found;
}

/// Curves are traced above a floor somewhat below the level, as they may be above it by their accuracy.
DriveCurveOptions below_level(double level, const Plan& plan, double unit, double step) {
  return {level - 2 * plan.accuracy, plan.accuracy, unit / 64, step};
}

/// Puts the levels' stretches together to one path.
class Rougher {
 public:
  Rougher(const RoughJob& job, const PassLayout& layout, MillReport& report)
      : job_(job),
        layout_(layout),
        plan_(job.plan),
        o_(job.o),
        bodies_(make_bodies(job.cutter, job.plan.slack)),
        report_(report) {}
  ToolPath path;

  /// `above`: the level above it, in units, or the top of the stock.
  void cut(Level& level, std::int64_t above) {
    k_ = level.k, above_ = above;
    level_ = job_.level(k_);
    curve_.emplace(*bodies_, below_level(level_, plan_, o_.accuracy.unit, layout_.step));
    for (auto& pass : level.passes)
      for (Stretch& s : pass)
        if (!s.done) cut_region(level, s);
  }
  void finish() {
    if (!path.moves.empty()) go(MoveKind::rapid, {at_.x, at_.y, plan_.safe}, 0);
  }

 private:
  Point3 place(std::size_t pass, std::int64_t i, std::int64_t k) const {
    const PassLayout::Pass& p = layout_.passes[pass];
    const double unit = o_.accuracy.unit;
    return {double(p.i0 + i * layout_.p) * unit, double(p.j0 + i * layout_.q) * unit, double(k) * unit + plan_.tip};
  }
  void go(MoveKind kind, Point3 to, double feed) {
    if (to == at_) return;
    path.moves.push_back({kind, ArcPlane::xy, to, {}, feed});
    at_ = to;
  }

  /// The stretch, and then one that overlaps it on the next pass, as long as there is one to which the way is free.
  void cut_region(Level& level, Stretch& first) {
    Stretch* s = &first;
    bool forwards = true;
    if (!enter(*s, forwards)) return;
    while (true) {
      s->done = true;
      go(MoveKind::line, place(s->pass, forwards ? s->last : s->first, k_), o_.motion.feed);
      if (s->pass + 1 == level.passes.size()) return;
      Stretch* next = nullptr;
      for (Stretch& t : level.passes[s->pass + 1])
        if (next == nullptr && !t.done && t.first <= s->last && t.last >= s->first && is_free(*s, t, forwards))
          next = &t;
      if (next == nullptr) return;
      forwards = !forwards;
      go(MoveKind::line, place(next->pass, forwards ? next->first : next->last, k_), o_.motion.feed);
      s = next;
    }
  }

  /// Whether the tool can go from the end of one stretch to that of another on the level.
  bool is_free(const Stretch& from, const Stretch& to, bool forwards) {
    const Point3 origin = layout_.lattice.origin;
    const Point3 a = place(from.pass, forwards ? from.last : from.first, k_),
                 b = place(to.pass, forwards ? to.last : to.first, k_);
    const double dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
    if (length > 4 * layout_.step_over) return false;
    const Line line{{a.x - origin.x, a.y - origin.y}, {dx / length, dy / length}};
    return curve_->highest(line, 0, length) <= level_;
  }

  /// Down to an end of the stretch: beside the stock, or by a ramp.
  bool enter(Stretch& s, bool& forwards) {
    const PassLayout::Pass& p = layout_.passes[s.pass];
    if (s.first == p.first || s.last == p.last) {
      forwards = s.first == p.first;
      const Point3 start = place(s.pass, forwards ? s.first : s.last, k_);
      descend({start.x, start.y, start.z});
      go(MoveKind::line, start, o_.motion.plunge_feed);
      return true;
    }
    const double length = double(s.last - s.first) * layout_.step;
    const double depth = double(above_ - k_) * o_.accuracy.unit;
    if (length < radius_of(o_.tool)) {
      s.done = true;
      ++report_.skipped_cuts;
      return false;
    }
    // To and fro; the last leg ends where the cut begins.
    const double needed = depth / std::tan(o_.ramp_angle * std::numbers::pi / 180);
    const std::int64_t legs = std::max<std::int64_t>(1, std::int64_t(std::ceil(needed / length)));
    const std::int64_t part =
        std::min(s.last - s.first, std::int64_t(std::ceil(needed / double(legs) / layout_.step)) + 1);
    bool at_first = legs % 2 == 0;
    const auto end = [&](bool first) { return first ? s.first : s.first + part; };
    descend(place(s.pass, end(at_first), above_));
    for (std::int64_t n = 1; n <= legs; ++n) {
      at_first = !at_first;
      const std::int64_t k = n == legs ? k_ : above_ - std::int64_t(double(above_ - k_) * double(n) / double(legs));
      go(MoveKind::line, place(s.pass, end(at_first), k), o_.motion.plunge_feed);
    }
    if (!at_first) go(MoveKind::line, place(s.pass, s.first, k_), o_.motion.feed);
    forwards = true;
    return true;
  }

  /// Rapidly over everything, and down to the level above; not into what may still be stock.
  void descend(Point3 to) {
    if (path.moves.empty()) path.start = at_ = {to.x, to.y, plan_.safe};
    go(MoveKind::rapid, {at_.x, at_.y, plan_.safe}, 0);
    go(MoveKind::rapid, {to.x, to.y, plan_.safe}, 0);
    const std::int64_t k = above_ + std::int64_t(std::ceil(job_.clearance() / o_.accuracy.unit));
    const Point3 near{to.x, to.y, double(k) * o_.accuracy.unit + plan_.tip};
    if (near.z < at_.z) go(MoveKind::rapid, near, 0);
    if (to.z < at_.z) go(MoveKind::line, to, o_.motion.plunge_feed);
  }

  const RoughJob& job_;
  const PassLayout& layout_;
  const Plan& plan_;
  const RoughOptions& o_;
  std::unique_ptr<LineBodies> bodies_;
  std::optional<DriveCurve> curve_;
  MillReport& report_;
  std::int64_t k_ = 0, above_ = 0;
  double level_ = 0;  // relative to the part's origin
  Point3 at_;
};

}  // namespace

Result<ToolPath> rough_by_zigzag(const RoughJob& job, MillReport& report, const Context& context) {
  const Plan& plan = job.plan;
  const RoughOptions& o = job.o;
  const double unit = o.accuracy.unit;
  // Ends of passes are a unit and more outside of the stock's reach.
  const double turn = o.angle * std::numbers::pi / 180, wider = std::abs(std::cos(turn)) + std::abs(std::sin(turn));
  const double margin = 1.01 * o.stock_margin * wider + plan.radius + 2 * unit;
  const PassLayout layout =
      lay_passes(job.cutter.drop.terrain(), unit, o.angle, plan.step_over, margin, o.accuracy.tolerance);
  const std::size_t passes = layout.passes.size(), levels = job.heights.size() - 1;
  std::vector<Level> cuts(levels);
  for (std::size_t n = 0; n < levels; ++n) cuts[n].k = job.heights[n + 1], cuts[n].passes.resize(passes);
  kernel::Progress progress(context, levels * passes);
  const bool done = kernel::parallel_blocks(context, levels * passes, 1, [&](std::size_t work, std::size_t) {
    Level& level = cuts[work / passes];
    const std::size_t k = work % passes;
    const PassLayout::Pass& pass = layout.passes[k];
    const double height = job.level(level.k);
    const std::unique_ptr<LineBodies> bodies = make_bodies(job.cutter, plan.slack);
    DriveCurve curve(*bodies, below_level(height, plan, unit, layout.step));
    std::vector<CurveRun> runs;
    curve.trace(layout.line(pass), double(pass.first) * layout.step, double(pass.last) * layout.step, true, runs);
    if (!runs.empty()) level.passes[k] = stretches_below(runs.front(), height, layout.step, k);
    progress.add(1);
  });
  if (!done) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  Rougher rougher(job, layout, report);
  for (std::size_t n = 0; n < levels; ++n) {
    for (const auto& pass : cuts[n].passes) report.cuts += pass.size();
    rougher.cut(cuts[n], job.heights[n]);
    if (context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  }
  rougher.finish();
  report.passes = passes;
  report.step_over = layout.step_over, report.angle = layout.angle();
  return std::move(rougher.path);
}

}  // namespace krepl::mill
