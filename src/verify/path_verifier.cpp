#include "verify/path_verifier.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "verify/solid.hpp"
#include "verify/tally.hpp"
#include "verify/tool_depth.hpp"

namespace krepl::verify {
namespace {

constexpr std::uint64_t usual_samples = 200000;
constexpr double farthest = 1000;  // from the part, in units of S: a machine's home may be away from it

/// One move of the ball's centre, as a curve over [0,1].
class Way {
 public:
  Way(Point3 from, const Move& move) : from_(from), to_(move.end) {
    if (move.kind != MoveKind::clockwise && move.kind != MoveKind::counter_clockwise) {
      length_ = double(root(square(to_ - from_)));
      return;
    }
    arc_ = true;
    // u, v, w: so that u turns to v counter-clockwise, seen against w.
    axis_ = move.plane == ArcPlane::xy ? 0 : move.plane == ArcPlane::zx ? 2 : 1;
    const Space<Real> a = turned(from_), b = turned(to_), c = turned(Space<Real>(move.centre));
    centre_ = c;
    start_ = std::atan2(a.y - c.y, a.x - c.x);
    const Real end = std::atan2(b.y - c.y, b.x - c.x), whole = 2 * std::numbers::pi_v<Real>;
    const bool left = move.kind == MoveKind::counter_clockwise;
    Real turn = left ? end - start_ : start_ - end;
    if (a.x == b.x && a.y == b.y)
      turn = whole;
    else if (turn <= 0)
      turn += whole;
    turn_ = left ? turn : -turn;
    first_radius_ = std::hypot(a.x - c.x, a.y - c.y), last_radius_ = std::hypot(b.x - c.x, b.y - c.y);
    length_ = double(std::hypot(turn * std::max(first_radius_, last_radius_), b.z - a.z));
  }
  double length() const { return length_; }
  Space<Real> at(Real t) const {
    if (!arc_ || t == 0 || t == 1) return t == 1 ? to_ : from_ + t * (to_ - from_);
    const Real r = first_radius_ + t * (last_radius_ - first_radius_), angle = start_ + t * turn_;
    const Real w = turned(from_).z + t * (turned(to_).z - turned(from_).z);
    return back({centre_.x + r * std::cos(angle), centre_.y + r * std::sin(angle), w});
  }

 private:
  Space<Real> turned(Space<Real> p) const {
    return axis_ == 0 ? p : axis_ == 1 ? Space<Real>{p.y, p.z, p.x} : Space<Real>{p.z, p.x, p.y};
  }
  Space<Real> back(Space<Real> p) const {
    return axis_ == 0 ? p : axis_ == 1 ? Space<Real>{p.z, p.x, p.y} : Space<Real>{p.y, p.z, p.x};
  }
  Space<Real> from_, to_, centre_;
  bool arc_ = false;
  int axis_ = 0;  // 0: xy, 1: yz, 2: zx
  Real start_ = 0, turn_ = 0, first_radius_ = 0, last_radius_ = 0;
  double length_ = 0;
};

/// How deep the ball is in the solid with its centre at p.
double depth_at(const Solid& solid, Space<Real> p, const PathCheckOptions& options, double limit) {
  const Space<double> centre(
      Space<Real>{p.x - solid.origin().x, p.y - solid.origin().y, p.z + options.lift - solid.origin().z});
  const double depth = options.radius - solid.distance(centre, options.radius);
  return depth <= limit ? depth : options.radius - solid.distance_carefully(centre, options.radius);
}

/// How far the ends of moves are from the part's middle: what leads away, the checks of places along the path would hardly look at.
Tally stray(const ToolPath& path, const Solid& solid, double allowed) {
  Tally tally;
  for (const Move& move : path.moves) {
    const Point3 o = solid.origin(), p = move.end;
    tally.add(std::max({std::abs(p.x - o.x), std::abs(p.y - o.y), std::abs(p.z - o.z)}), allowed, {p.x, p.y});
  }
  return tally;
}

}  // namespace

Result<PathReport> check_path(const ToolPath& path, const Terrain& part, const PathCheckOptions& options,
                              const Context& context) {
  if (!std::isfinite(options.radius) || !(options.radius > 0))
    return Error{ErrorCode::usage, "the radius is not a finite number greater than zero", "", ""};
  if (path.moves.empty()) return Error{ErrorCode::input, "holds no move", "", ""};
  const Solid solid(part);
  std::optional<ToolDepth> tool;
  if (options.cutter) tool.emplace(solid, *options.cutter);
  PathReport report;
  report.radius = options.radius, report.moves = path.moves.size(), report.triangles = solid.triangle_count();
  report.scale = std::max(options.radius, 2 * solid.half_extent());
  report.tolerance = std::max(1e-9 * report.scale, 64 * solid.resolution()) + options.max_error;

  std::vector<Way> ways;
  Point3 from = path.start;
  for (const Move& move : path.moves) {
    ways.emplace_back(from, move);
    report.length += ways.back().length();
    from = move.end;
  }
  const std::uint64_t samples = options.samples > 0 ? options.samples : usual_samples;
  report.step = report.length / double(samples);
  const auto check = [&](bool rapid) {
    return tally_all(context, ways.size(), [&](std::size_t i, Tally& tally) {
      if ((path.moves[i].kind == MoveKind::rapid) != rapid || context.cancelled()) return;
      const Way& way = ways[i];
      const std::uint64_t parts = 2 + std::uint64_t(report.step > 0 ? way.length() / report.step : 0);
      for (std::uint64_t k = 0; k <= parts; ++k) {
        const Space<Real> p = way.at(Real(k) / Real(parts));
        const Point3 origin = solid.origin();
        const double depth = tool ? tool->at(Space<double>(Space<Real>{p.x - origin.x, p.y - origin.y, p.z - origin.z}), report.tolerance)
                                  : depth_at(solid, p, options, report.tolerance);
        tally.add(depth, report.tolerance, {p.x, p.y});
      }
    });
  };
  report.checks.push_back(check(false).check("cutting moves stay out", report.tolerance));
  report.checks.push_back(check(true).check("rapid moves stay out", report.tolerance));
  const double near = farthest * report.scale;
  report.checks.push_back(stray(path, solid, near).check("moves stay near the part", near));
  if (context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  return report;
}

}  // namespace krepl::verify
