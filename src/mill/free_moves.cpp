#include "mill/free_moves.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mill/grown_cutter.hpp"

namespace krepl::mill {
namespace {

bool is_arc(const Move& m) { return m.kind == MoveKind::clockwise || m.kind == MoveKind::counter_clockwise; }

}  // namespace

Result<DropCutter> make_prover(const DropCutter& cutter, const Plan& plan, const Band& band, const MillTool& tool) {
  if (plan.lift == 0) return cutter.with_radius(band.proof_radius);
  const Result<Cutter> larger = grow(*tool.cutter, tool.allowance, band.proof_room);
  if (!larger) return larger.error();
  return cutter.with_cutter(*larger);
}

double prover_lift(const Plan& plan, const Band& band, const MillTool& tool) {
  return plan.lift == 0 ? 0 : tool.allowance + band.proof_room;
}

void append_chords(Point3 from, const Move& arc, double sagitta, std::vector<Point3>& points) {
  // The first axis of the plane, the second, and the one across: X Y Z, Z X Y, Y Z X.
  double Point3::*const axes[] = {&Point3::x, &Point3::y, &Point3::z};
  const int shift = arc.plane == ArcPlane::xy ? 0 : arc.plane == ArcPlane::zx ? 2 : 1;
  const auto first = axes[shift], second = axes[(shift + 1) % 3], along = axes[(shift + 2) % 3];
  const double ax = from.*first - arc.centre.*first, ay = from.*second - arc.centre.*second,
               bx = arc.end.*first - arc.centre.*first, by = arc.end.*second - arc.centre.*second;
  const double r0 = std::hypot(ax, ay), r1 = std::hypot(bx, by), start = std::atan2(ay, ax);
  double turn = std::atan2(ax * by - ay * bx, ax * bx + ay * by);
  if (arc.kind == MoveKind::counter_clockwise && turn <= 0) turn += 2 * std::numbers::pi;
  if (arc.kind == MoveKind::clockwise && turn >= 0) turn -= 2 * std::numbers::pi;
  const double radius = std::max(r0, r1);
  // Half the sagitta: the change of radius bends the arc a little more.
  const double step = 2 * std::acos(std::max(0.0, 1 - sagitta / (2 * radius)));
  const double count = std::max(2.0, std::ceil(std::abs(turn) / step));
  for (double n = 1; n < count; ++n) {
    const double s = n / count, angle = start + s * turn, r = r0 + s * (r1 - r0);
    Point3 p;
    p.*first = arc.centre.*first + r * std::cos(angle), p.*second = arc.centre.*second + r * std::sin(angle);
    p.*along = from.*along + s * (arc.end.*along - from.*along);
    points.push_back(p);
  }
  points.push_back(arc.end);
}

/// The highest place of the surface over the way, less `slope` a unit of it; relative to the part's origin.
double FreeMoves::highest(Point3 from, Point3 to, double slope, double floor, double accuracy) {
  const Point3 origin = cutter_.drop.terrain().origin();
  if (!bodies_ || accuracy != accuracy_) {
    curve_.reset();
    bodies_ = make_bodies(cutter_, accuracy / 4);
  }
  if (!curve_ || floor != floor_)
    curve_.emplace(*bodies_, DriveCurveOptions{floor, accuracy, std::min(unit_ / 64, accuracy / 16), unit_});
  floor_ = floor, accuracy_ = accuracy;
  const double dx = to.x - from.x, dy = to.y - from.y, length = std::hypot(dx, dy);
  const Line line{{from.x - origin.x, from.y - origin.y}, {dx / length, dy / length}};
  return curve_->highest_above(line, 0, length, slope);
}

bool FreeMoves::is_free_line(Point3 from, Point3 to) {
  const Point3 origin = cutter_.drop.terrain().origin();
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const Point3 low = from.z < to.z ? from : to;
  if (length == 0) return cutter_.height({low.x - origin.x, low.y - origin.y}) <= low.z - origin.z;
  const double slope = (to.z - from.z) / length;
  // Bounds are accurate normal to the curve: next to steep tops it takes finer ones.
  for (const double finer : {2.0, 64.0, 2048.0})
    if (highest(from, to, slope, low.z - origin.z - band_.proof_accuracy, band_.proof_accuracy / finer) <=
        from.z - origin.z)
      return true;
  return false;
}

bool FreeMoves::is_free(Point3 from, const Move& move) {
  if (!is_arc(move)) return is_free_line(from, move.end);
  std::vector<Point3> points;
  append_chords(from, move, band_.sagitta, points);
  for (const Point3 p : points) {
    if (!is_free_line(from, p)) return false;
    from = p;
  }
  return true;
}

double FreeMoves::round_up(double z) const { return std::ceil((z - plan_.z0) / unit_) * unit_ + plan_.tip; }

/// The place, or a free one straight above it.
Point3 FreeMoves::raised(Point3 p) const {
  const Point3 origin = cutter_.drop.terrain().origin();
  const double height = cutter_.height({p.x - origin.x, p.y - origin.y});
  return height <= p.z - origin.z ? p : Point3{p.x, p.y, round_up(height)};
}

/// A height of the lattice above the surface below the move, absolute.
double FreeMoves::top_over(Point3 from, const Move& move) {
  std::vector<Point3> points;
  if (is_arc(move))
    append_chords(from, move, band_.sagitta, points);
  else
    points.push_back(move.end);
  const Point3 origin = cutter_.drop.terrain().origin();
  double top = std::max(from.z, move.end.z) - origin.z;
  for (const Point3 p : points) {
    top = std::max({top, cutter_.height({p.x - origin.x, p.y - origin.y}),
                    cutter_.height({from.x - origin.x, from.y - origin.y})});
    if (p.x != from.x || p.y != from.y) top = std::max(top, highest(from, p, 0, plan_.floor, band_.proof_accuracy));
    from = p;
  }
  return round_up(top);
}

std::size_t FreeMoves::settle(Cut& cut, double lift_feed) {
  std::vector<Move> moves;
  std::size_t lifted = 0;
  cut.start = raised(cut.start);
  Point3 at = cut.start;
  for (Move m : cut.moves) {
    const Point3 end = raised(m.end);
    const bool is_as_planned = end == m.end && (!is_arc(m) || at.z == end.z);
    m.end = end;
    if (is_as_planned && is_free(at, m)) {
      moves.push_back(m);
    } else {
      ++lifted;
      const double top = top_over(at, m);
      m.end.z = top, m.feed = lift_feed;
      moves.push_back({MoveKind::line, ArcPlane::xy, {at.x, at.y, top}, {}, m.feed});
      moves.push_back(m);
      moves.push_back({MoveKind::line, ArcPlane::xy, end, {}, m.feed});
    }
    at = end;
  }
  cut.moves = std::move(moves);
  return lifted;
}

}  // namespace krepl::mill
