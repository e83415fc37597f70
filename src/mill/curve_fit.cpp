#include "mill/curve_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace krepl::mill {
namespace {

constexpr double right_angle = std::numbers::pi / 2;

}  // namespace

std::int64_t CurveFit::above(double z) const { return std::int64_t(std::ceil((z - options_.z0) / options_.unit)); }
std::int64_t CurveFit::before(double t) const { return std::int64_t(std::floor(t / options_.step)); }

double CurveFit::highest(double low, double high, std::size_t hint) const {
  const auto on_segment = [&](std::size_t v, double t) {
    const CurvePoint p = curve_[v], q = curve_[v + 1];
    return q.t > p.t ? p.z + (q.z - p.z) * ((t - p.t) / (q.t - p.t)) : std::max(p.z, q.z);
  };
  // Multiples of the step may be off the run's ends by rounding.
  low = std::clamp(low, curve_.front().t, curve_.back().t), high = std::clamp(high, low, curve_.back().t);
  double top = -std::numeric_limits<double>::infinity();
  std::size_t v = std::min(hint, curve_.size() - 1);
  while (v > 0 && curve_[v].t >= low) --v;
  for (; v + 1 < curve_.size() && curve_[v].t <= high; ++v) {
    if (curve_[v + 1].t < low) continue;
    top = std::max({top, on_segment(v, std::max(low, curve_[v].t)), on_segment(v, std::min(high, curve_[v + 1].t))});
  }
  return top;
}

/// The farthest line: of all directions from p, those above the points of the curve passed so far and within the band
/// of them. Points from `open` on that p has passed already, at the foot of a wall, must be within the band, too.
std::optional<FittedMove> CurveFit::line_from(LatticePoint p, std::size_t open, std::size_t next) const {
  const double pt = t(p.i), pz = z(p.k);
  double low = -right_angle, high = right_angle;
  std::size_t last = next;
  bool any = false;
  for (std::size_t v = open; v < next; ++v) {
    const double dt = curve_[v].t - pt, dz = curve_[v].z - pz, distance = std::hypot(dt, dz);
    if (dz < 0 && distance > options_.band)
      high = std::min(high, std::atan2(dz, dt) + std::asin(options_.band / distance));
  }
  if (high <= low) return std::nullopt;
  for (std::size_t v = next; v < curve_.size(); ++v) {
    const double dt = curve_[v].t - pt, dz = curve_[v].z - pz, distance = std::hypot(dt, dz);
    const double angle = std::atan2(dz, dt);
    const double new_low = std::max(low, angle);
    const double new_high =
        distance > options_.band ? std::min(high, angle + std::asin(options_.band / distance)) : high;
    if (new_low > new_high) break;
    low = new_low, high = new_high, last = v, any = true;
  }
  if (!any) return std::nullopt;
  // Not beyond the foot of the last point on the line: on the way up a wall that is long before the point's t.
  const double middle = (low + std::min(high, right_angle)) / 2;
  const double foot = (curve_[last].t - pt) * std::cos(middle) + (curve_[last].z - pz) * std::sin(middle);
  const std::int64_t i = std::min(before(curve_[last].t), before(pt + foot * std::cos(middle)));
  if (i <= p.i) return std::nullopt;
  const double dt = t(i) - pt, at = highest(t(i), t(i), last);
  const double least = pz + std::tan(low) * dt;
  const double most = high < right_angle ? pz + std::tan(high) * dt : std::numeric_limits<double>::infinity();
  // The middle of the band; on a steep line, where that is far up, the middle of the directions.
  double wanted = pz + std::tan(middle) * dt;
  if (std::cos(middle) > 0.25) wanted = std::min(at + options_.band / 2 / std::cos(middle), most - options_.unit);
  wanted = std::max({wanted, least, at});
  // On another line than the middle one the end may be beyond the foot of the last point.
  const bool beyond = (curve_[last].t - t(i)) * dt + (curve_[last].z - wanted) * (wanted - pz) < 0;
  if (beyond) wanted = std::max({pz + std::tan(middle) * dt, least, at});
  return FittedMove{FittedMove::Kind::line, {i, above(wanted)}, {}};
}

/// Where no line gets to the next multiple of the step: next to a wall. Up and over, or over and down.
void CurveFit::step_aside(LatticePoint& p, std::size_t next, std::vector<FittedMove>& moves) const {
  const std::size_t hint = next > 0 ? next - 1 : 0;
  const auto go = [&](LatticePoint q) {
    if (!(q == p)) moves.push_back({FittedMove::Kind::line, q, {}});
    p = q;
  };
  const std::int64_t foot = above(highest(t(p.i), t(p.i), hint));
  if (z(p.k) - z(foot) > options_.band) return go({p.i, foot});
  const std::int64_t top = std::max(p.k, above(highest(t(p.i), t(p.i + 1), hint)));
  go({p.i, top});
  go({p.i + 1, top});
  const std::int64_t bottom = above(highest(t(p.i), t(p.i), hint));
  if (z(p.k) - z(bottom) > options_.band) go({p.i, bottom});
}

LatticePoint CurveFit::run(std::vector<FittedMove>& moves) {
  const std::int64_t first = std::int64_t(std::llround(curve_.front().t / options_.step));
  const std::int64_t end = std::int64_t(std::llround(curve_.back().t / options_.step));
  LatticePoint p{first, above(highest(t(first), t(first), 0) + options_.band / 2)};
  const LatticePoint start = p;
  std::size_t next = 0, open = 0;  // first vertex beyond p, and beyond p along the last move
  double along_t = 1, along_z = 0;
  while (p.i < end) {
    while (next < curve_.size() && curve_[next].t <= t(p.i)) ++next;
    if (next == curve_.size()) break;
    const auto is_passed = [&](CurvePoint v) {
      const double dt = v.t - t(p.i), dz = v.z - z(p.k);
      return dt * along_t + dz * along_z <= 0 || std::hypot(dt, dz) <= options_.band;
    };
    while (open < next && is_passed(curve_[open])) ++open;
    std::optional<FittedMove> move = line_from(p, open, next);
    if (options_.most_radius > 0 && open == next) {
      if (const auto arc = arc_from(p, next, move ? move->end.i : p.i)) move = arc;
    }
    const LatticePoint before_it = p;
    if (move) {
      moves.push_back(*move);
      p = move->end;
    } else {
      step_aside(p, next, moves);
    }
    along_t = t(p.i) - t(before_it.i), along_z = z(p.k) - z(before_it.k);
  }
  return start;
}

}  // namespace krepl::mill
