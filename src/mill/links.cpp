#include "mill/links.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/parallel.hpp"
#include "mill/drive_curve.hpp"

namespace krepl::mill {
namespace {

/// Lattice heights at or above z.
double round_up(double z, const LinkOptions& o) { return o.z0 + std::ceil((z - o.z0) / o.unit) * o.unit; }

/// The highest place of the cutter's surface between two places, absolute.
double highest_between(DriveCurve& curve, Point3 a, Point3 b, Point3 origin) {
  const double dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
  const Point from{a.x - origin.x, a.y - origin.y};
  const Line line{from, length > 0 ? Point{dx / length, dy / length} : Point{1, 0}};
  return curve.highest(line, 0, length) + origin.z;
}

class Linker {
 public:
  Linker(const LinkOptions& options) : o_(options) {}
  ToolPath path;

  void go(MoveKind kind, Point3 to, double feed) {
    if (to == at_) return;
    path.moves.push_back({kind, ArcPlane::xy, to, {}, feed});
    at_ = to;
  }
  void start(Point3 first) {
    path.start = at_ = {first.x, first.y, o_.safe_height};
    descend(first);
  }
  /// Straight down to the start of a cut: rapidly to a clearance above it.
  void descend(Point3 to) {
    const double near = round_up(to.z + o_.clearance, o_);
    if (near < at_.z) go(MoveKind::rapid, {to.x, to.y, near}, 0);
    go(MoveKind::line, to, o_.plunge_feed);
  }
  void cut(Cut& c) {
    for (const Move& m : c.moves) path.moves.push_back(m);
    at_ = c.end();
  }
  void link(Point3 to, double top) {
    const double length = std::hypot(to.x - at_.x, to.y - at_.y);
    if (length <= o_.short_link) {
      const double level = std::max({at_.z, to.z, round_up(top, o_)});
      go(MoveKind::line, {at_.x, at_.y, level}, o_.feed);
      go(MoveKind::line, {to.x, to.y, level}, o_.feed);
      go(MoveKind::line, to, o_.plunge_feed);
      return;
    }
    const double level =
        std::min(std::max(round_up(std::max({at_.z, to.z, top}) + o_.clearance, o_), at_.z), o_.safe_height);
    go(MoveKind::rapid, {at_.x, at_.y, level}, 0);
    go(MoveKind::rapid, {to.x, to.y, level}, 0);
    descend(to);
  }
  void link_over(Point3 to) {
    go(MoveKind::rapid, {at_.x, at_.y, o_.safe_height}, 0);
    go(MoveKind::rapid, {to.x, to.y, o_.safe_height}, 0);
    descend(to);
  }
  bool stays_inside(Point3 to, Point3 origin) const {
    return o_.boundary == nullptr ||
           o_.boundary->contains({at_.x - origin.x, at_.y - origin.y}, {to.x - origin.x, to.y - origin.y});
  }
  void finish() { go(MoveKind::rapid, {at_.x, at_.y, o_.safe_height}, 0); }

 private:
  const LinkOptions& o_;
  Point3 at_;
};

}  // namespace

Result<ToolPath> link_cuts(const LiftedCutter& cutter, std::vector<Cut>&& cuts, const LinkOptions& options,
                           const Context& context) {
  const Point3 origin = cutter.drop.terrain().origin();
  std::vector<double> top(cuts.size(), 0.0);  // between cut k - 1 and cut k
  Context quiet;
  quiet.threads = context.threads, quiet.cancel = context.cancel;
  const bool done = kernel::parallel_blocks(quiet, cuts.size(), 16, [&](std::size_t first, std::size_t last) {
    const double smallest = options.unit / 64, accuracy = std::max(cutter.drop.radius() / 32, options.unit);
    const std::unique_ptr<LineBodies> bodies = make_bodies(cutter, accuracy / 4);
    DriveCurve curve(*bodies, {options.floor, accuracy, smallest, options.unit});
    for (std::size_t k = std::max<std::size_t>(first, 1); k < last; ++k)
      top[k] = highest_between(curve, cuts[k - 1].end(), cuts[k].start, origin);
  });
  if (!done) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  Linker linker(options);
  for (std::size_t k = 0; k < cuts.size(); ++k) {
    if (k == 0)
      linker.start(cuts[k].start);
    else if (linker.stays_inside(cuts[k].start, origin))
      linker.link(cuts[k].start, top[k]);
    else
      linker.link_over(cuts[k].start);
    linker.cut(cuts[k]);
    cuts[k] = {};
  }
  linker.finish();
  return std::move(linker.path);
}

LinkOptions links_of(const Plan& plan, const MillTool& tool, const MillAccuracy& accuracy, const MillMotion& motion,
                     double feed, double short_link) {
  const double clearance = motion.clearance >= 0 ? motion.clearance : radius_of(tool) / 2;
  return {plan.safe, clearance, feed, motion.plunge_feed, short_link, plan.floor, accuracy.unit, plan.tip, nullptr};
}

Result<MilledPath> finish_path(const LiftedCutter& cutter, std::vector<Cut>&& cuts, const LinkOptions& options,
                               const MillMotion& motion, MilledPath milled, const Context& context) {
  Result<ToolPath> path = link_cuts(cutter, std::move(cuts), options, context);
  if (!path) return path.error();
  milled.path = std::move(*path);
  measure(milled.path, motion, milled.report);
  return milled;
}

}  // namespace krepl::mill
