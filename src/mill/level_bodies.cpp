#include "mill/level_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mill/part_domain.hpp"
#include "terrain/drop_cutter_part.hpp"

namespace krepl::mill {
namespace {

constexpr Interval no_interval{1, 0};
constexpr int most_steps = 200;

/// A cutter of less radius, nearly of the same profile.
Cutter shrink(const Cutter& cutter, double radius) {
  const auto smaller = [&]() -> Result<Cutter> {
    switch (cutter.kind()) {
      case Cutter::Kind::flat:
        return Cutter::flat(2 * radius);
      case Cutter::Kind::bull_nose:
        return Cutter::bull_nose(2 * radius, std::min(cutter.corner_radius(), radius));
      case Cutter::Kind::cone:
        return Cutter::cone(2 * radius, cutter.angle());
      case Cutter::Kind::taper:
        return Cutter::taper(2 * radius, cutter.angle(), cutter.corner_radius());
      case Cutter::Kind::ball:
        break;
    }
    return Cutter::ball(2 * radius);
  }();
  return smaller ? *smaller : *Cutter::ball(2 * radius);  // of a taper the tip is left
}

bool touches(const Touch& touch) { return touch.height != drop::nothing; }

}  // namespace

LevelBodies::LevelBodies(const LiftedCutter& cutter, double level, double grain)
    : search_(cutter.drop),
      tool_(cutter.drop.cutter()),
      level_(level - cutter.lift),
      grain_(grain),
      closest_(std::max(grain * 0x1p-10, 0x1p-48 * std::max(cutter.drop.terrain().extent(), tool_.radius))) {}

bool LevelBodies::is_covered_by(const drop::Part& part, Point low, Point high) const {
  drop::ProfileTool tool = tool_;
  for (const Point corner : {low, high, Point{low.x, high.y}, Point{high.x, low.y}}) {
    tool.place = corner;
    if (!(drop::touch_part(part, tool).height > level_ + grain_)) return false;
  }
  return true;
}

bool LevelBodies::is_covered(Point low, Point high) {
  const double half = (high.x - low.x) * std::numbers::sqrt2 / 2;
  if (half >= tool_.radius) return false;
  const Point centre{low.x / 2 + high.x / 2, low.y / 2 + high.y / 2};
  drop::Part part;
  if (!search_.find_touched(centre, part)) return false;
  if (is_covered_by(part, low, high)) return true;
  auto found = inner_.find(high.x - low.x);
  if (found == inner_.end()) {
    const auto smaller = search_.cutter().with_cutter(shrink(search_.cutter().cutter(), tool_.radius - half));
    found = inner_.emplace(high.x - low.x, smaller ? std::make_unique<Inner>(*smaller) : nullptr).first;
  }
  return found->second && found->second->search.find_touched(centre, part) && is_covered_by(part, low, high);
}

Touch LevelBodies::touch(std::size_t part, const Line& line, double t) const {
  drop::ProfileTool tool = tool_;
  tool.place = line.at(t);
  const drop::PartTouch touch = drop::touch_part(parts_[part], tool);
  return {touch.height, touch.slope.x * line.direction.x + touch.slope.y * line.direction.y};
}

/// Where the way from `inside`, where it rests higher, to `outside`, where it does not, gets out; on the outer side.
double LevelBodies::end_of(std::size_t part, const Line& line, double inside, double outside) const {
  double z = touch(part, line, inside).height;
  Touch beyond = touch(part, line, outside);
  if (!touches(beyond)) {
    // Heights may jump where the body ends.
    const Interval domain = domain_of(parts_[part], tool_.radius, line);
    const double end = outside > inside ? domain.high : domain.low, step = outside > inside ? closest_ : -closest_;
    if (std::abs(end - inside) < std::abs(outside - inside)) outside = end;
    if (std::abs(end - inside) <= closest_) return outside;
    const Touch near = touch(part, line, end - step);
    if (near.height > level_) return outside;
    if (touches(near)) outside = end - step, beyond = near;
  }
  for (int k = 0; k < most_steps && std::abs(outside - inside) > closest_; ++k) {
    const double width = outside - inside;
    const auto attempt = [&](double t) {
      if (!((t > inside && t < outside) || (t < inside && t > outside))) return;
      const Touch at = touch(part, line, t);
      if (at.height > level_)
        inside = t, z = at.height;
      else
        outside = t, beyond = at;
    };
    if (touches(beyond)) {
      if (beyond.slope != 0) attempt(outside + (level_ - beyond.height) / beyond.slope);
      if (touches(beyond)) attempt(inside + (z - level_) / (z - beyond.height) * (outside - inside));
    }
    if (std::abs(outside - inside) > std::abs(width) / 2) attempt(inside + (outside - inside) / 2);
  }
  return outside;
}

/// By the tangents at both ends; where there is none the body begins or ends between.
bool LevelBodies::may_rise_between(std::size_t part, const Line& line, double a, double b) const {
  const Touch p = at_a_[part], q = at_b_[part];
  if (touches(p) && touches(q)) {
    const double turn = p.slope - q.slope;
    if (!(turn > 0)) return std::max(p.height, q.height) > level_;
    const double t = std::clamp(((q.height - p.height) - q.slope * (b - a)) / turn, 0.0, b - a);
    return p.height + p.slope * t > level_;
  }
  const Interval domain = domain_of(parts_[part], tool_.radius, line);
  if (!(domain.low < b && domain.high > a)) return false;
  if (touches(p)) return p.height + p.slope * (p.slope > 0 ? std::min(domain.high, b) - a : 0) > level_;
  if (touches(q)) return q.height - q.slope * (q.slope < 0 ? b - std::max(domain.low, a) : 0) > level_;
  return true;
}

/// Of a body that does not rise above the level at a or b: where it does between them.
Interval LevelBodies::interval_within(std::size_t part, const Line& line, double a, double b) const {
  const Interval domain = domain_of(parts_[part], tool_.radius, line);
  double low = std::max(a, domain.low + closest_), high = std::min(b, domain.high - closest_);
  if (!(low < high)) return no_interval;
  Touch p = touch(part, line, low), q = touch(part, line, high);
  double inside = std::numeric_limits<double>::quiet_NaN();
  if (p.height > level_) inside = low;
  if (q.height > level_) inside = high;
  for (int k = 0; k < most_steps && std::isnan(inside) && high - low > closest_; ++k) {
    double t = low + (high - low) / 2;
    if (touches(p) && touches(q)) {
      if (!(p.slope > 0 && q.slope < 0)) return no_interval;  // highest at an end
      const double off = ((q.height - p.height) - q.slope * (high - low)) / (p.slope - q.slope);
      if (!(p.height + p.slope * off > level_)) return no_interval;
      // In the middle now and then: next to a rim tangents are steep.
      if (k % 3 != 2 && off > 0 && off < high - low) t = low + off;
    }
    const Touch at = touch(part, line, t);
    if (at.height > level_)
      inside = t;
    else if (at.slope > 0)
      low = t, p = at;
    else
      high = t, q = at;
  }
  if (std::isnan(inside)) return no_interval;
  return {end_of(part, line, inside, a), end_of(part, line, inside, b)};
}

void LevelBodies::free_parts(const Line& line, double a, double b, std::vector<Interval>& free) {
  free.clear();
  at_a_.resize(parts_.size()), at_b_.resize(parts_.size());
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    at_a_[i] = touch(i, line, a), at_b_[i] = touch(i, line, b);
    if (at_a_[i].height > level_ && at_b_[i].height > level_) return;
  }
  double from = a, to = b;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (at_a_[i].height > level_ && (from == a || touch(i, line, from).height > level_))
      from = std::max(from, end_of(i, line, from, b));
    if (at_b_[i].height > level_ && (to == b || touch(i, line, to).height > level_))
      to = std::min(to, end_of(i, line, to, a));
  }
  covered_.clear();
  for (std::size_t i = 0; i < parts_.size() && to - from > grain_; ++i) {
    if (at_a_[i].height > level_ || at_b_[i].height > level_ || !may_rise_between(i, line, a, b)) continue;
    const Interval found = interval_within(i, line, a, b);
    if (found.low < found.high) covered_.push_back(found);
  }
  std::sort(covered_.begin(), covered_.end(), [](Interval p, Interval q) { return p.low < q.low; });
  covered_.push_back({to, to});
  for (const Interval& c : covered_) {
    if (c.low - from > grain_) free.push_back({from, std::min(c.low, to)});
    from = std::max(from, c.high);
    if (to - from <= grain_) break;
  }
}

bool LevelBodies::is_free(const Line& line, double a, double b) {
  free_parts(line, a, b, free_);
  return free_.size() == 1 && free_.front().low == a && free_.front().high == b;
}

bool LevelBodies::is_covered(const Line& line, double a, double b) {
  free_parts(line, a, b, free_);
  return free_.empty();
}

}  // namespace krepl::mill
