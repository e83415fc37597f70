#include "route/taut_search.hpp"

#include <algorithm>

namespace krepl::route {
namespace {

constexpr double hurry = 1.1;  // times what is left at least

}  // namespace

TautSearch::TautSearch(const FreeSpace& space, const Obstacles& obstacles, double radius, Slack slack)
    : space_(space),
      obstacles_(obstacles),
      radius_(radius),
      slack_(slack),
      angle_slack_(std::clamp(slack.tolerance / radius, 1e-13, 1e-3)),
      tree_(boxes()) {
  counters_.arcs = space.arcs().size();
}

std::vector<Box> TautSearch::boxes() const {
  std::vector<Box> boxes(space_.arcs().size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const FreeArc& a = space_.arcs()[i];
    const auto add = [&](double angle) {
      boxes[i].add(a.center + Point{radius_ * std::cos(angle), radius_ * std::sin(angle)});
    };
    add(a.from), add(a.from + a.span);
    for (int quarter = 0; quarter < 4; ++quarter) {
      const double angle = quarter * (turn / 4);
      if (positive_angle(angle - a.from) <= a.span) add(angle);
    }
    // So that what is within the slack beyond the ends of the arc is within the box.
    boxes[i].min_x -= slack_.tolerance, boxes[i].max_x += slack_.tolerance;
    boxes[i].min_y -= slack_.tolerance, boxes[i].max_y += slack_.tolerance;
  }
  return boxes;
}

Wheel TautSearch::wheel(Index w) const {
  if (w == none) return {from_, 0};
  if (w == goal()) return {to_, 0};
  return {arc(w).center, sense(w) * radius_};
}

/// The angle turned about a directed arc up to where the given vector from its centre points; nothing if that is off
/// it.
std::optional<double> TautSearch::along(Index w, Point normal) const {
  const FreeArc& a = arc(w);
  double at = positive_angle(std::atan2(normal.y, normal.x) - a.from);
  if (a.full) return clockwise(w) ? positive_angle(-at) : at;
  if (at > turn - angle_slack_) at = 0;
  if (at > a.span + angle_slack_) return std::nullopt;
  at = std::min(at, a.span);
  return clockwise(w) ? a.span - at : at;
}

/// Made at the first arrival; where a string may leave ahead of later ones is part of it, and bounds of routes only grow.
const Horizon& TautSearch::horizon(const Arrival& from) {
  auto& made = horizons_[from.wheel];
  if (!made) {
    const bool place = from.wheel == none;
    const double budget = std::max(0.0, limit_ - from.cost - distance(from.end, to_)) + slack_.tolerance;
    made = std::make_unique<Horizon>(obstacles_, wheel(from.wheel), place ? 0 : arc(from.wheel).from,
                                     place ? turn : arc(from.wheel).span, radius_, slack_.tolerance, Reach{to_, budget});
  }
  return *made;
}

/// The tangent from what is ahead of an arrival to a wheel, if both ends lie on their arcs.
std::optional<TautSearch::Link> TautSearch::link(const Arrival& from, Index target) const {
  const Wheel a = wheel(from.wheel), b = wheel(target);
  const auto t = tangent(a, b, slack_.tolerance);
  if (!t) return std::nullopt;
  Link l{*t, 0, 0, 0, std::atan2(t->direction.y, t->direction.x)};
  if (from.wheel != none) {
    const auto leaving = along(from.wheel, sense(from.wheel) * right(t->direction));
    if (!leaving) return std::nullopt;
    l.leaving -= sense(from.wheel) * (turn / 4);
    l.sweep = *leaving - from.at;
    if (arc(from.wheel).full) {
      l.sweep = positive_angle(l.sweep);
      if (l.sweep > turn - angle_slack_) l.sweep = 0;
    }
    if (l.sweep < -angle_slack_) return std::nullopt;
    l.sweep = std::max(l.sweep, 0.0);
  }
  if (target != goal()) {
    const auto arriving = along(target, sense(target) * right(t->direction));
    if (!arriving) return std::nullopt;
    l.at = *arriving;
  }
  l.cost = from.cost + radius_ * l.sweep + t->length;
  return l;
}

bool TautSearch::visible(const Arrival& from, Index target, const Tangent& t) {
  const std::uint64_t source = from.wheel == none ? goal() + 1 : from.wheel;
  const std::uint64_t key = source * (std::uint64_t(goal()) + 2) + target;
  const auto known = visible_.find(key);
  if (known != visible_.end()) return known->second;
  ++counters_.visibility_tests;
  return visible_[key] = !obstacles_.any_within(t.start, t.end, radius_ - slack_.tolerance);
}

/// True if an earlier arrival at the same arc gets to this place for no more.
bool TautSearch::dominated(Index w, double at, double cost) const {
  for (const Reached& r : reached_[w]) {
    double ahead = at - r.at;
    if (arc(w).full && ahead < 0) ahead += turn;
    if (ahead >= -angle_slack_ && r.cost + radius_ * std::max(ahead, 0.0) <= cost * (1 + 1e-15)) return true;
  }
  return false;
}

void TautSearch::push(double bound, Index arrival, Index target, int level) {
  if (bound > limit_) return;
  queue_.push({bound, order_++, arrival, target, std::int8_t(level)});
}

void TautSearch::push_tangent(Index arrival, Index target) {
  const auto l = link(arrivals_[arrival], target);
  if (!l) return;
  ++counters_.tangents;
  const double bound = l->cost + left(distance(l->tangent.end, to_));
  if (bound > limit_) return;
  if (horizon(arrivals_[arrival]).hides(l->leaving, l->tangent.length - slack_.tolerance)) return;
  push(bound, arrival, target, -1);
}

void TautSearch::arrive(const Arrival& arrival) {
  ++counters_.arrivals;
  const Index a = Index(arrivals_.size());
  arrivals_.push_back(arrival);
  push_tangent(a, goal());
  if (!tree_.empty()) push(arrival.cost + left(distance(arrival.end, to_)), a, 0, int(tree_.top()));
}

/// Looks into a node of the tree: its children wait with a bound of the route by way of them.
void TautSearch::open(const Entry& entry) {
  if (entry.level == 0) {
    push_tangent(entry.arrival, 2 * entry.target);
    push_tangent(entry.arrival, 2 * entry.target + 1);
    return;
  }
  const Arrival& from = arrivals_[entry.arrival];
  const Horizon& seen = horizon(from);
  const auto [first, last] = tree_.children(std::size_t(entry.level), entry.target);
  for (std::size_t i = first; i < last; ++i) {
    const Box& box = tree_.box(std::size_t(entry.level) - 1, i);
    const double bound = from.cost + distance(from.end, box) + left(distance(to_, box));
    if (bound > limit_ || seen.hides(box)) continue;
    push(bound, entry.arrival, Index(i), entry.level - 1);
  }
}

/// Takes a tangent whose turn has come; true if it ends at the goal.
bool TautSearch::follow(const Entry& entry) {
  const Arrival from = arrivals_[entry.arrival];
  const Link l = *link(from, entry.target);
  const bool last = entry.target == goal();
  if (!last && dominated(entry.target, l.at, l.cost)) return false;
  if (!visible(from, entry.target, l.tangent)) return false;
  const Arrival next{entry.target, l.at, l.cost, entry.arrival, l.tangent.start, l.tangent.end, l.sweep};
  if (last) {
    arrivals_.push_back(next);
    return true;
  }
  reached_[entry.target].push_back({l.at, l.cost});
  arrive(next);
  return false;
}

Result<std::vector<TautStretch>> TautSearch::run(Point from, Point to, const Context& context) {
  from_ = from, to_ = to;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Result<std::vector<TautStretch>> found = search(hurry, infinity, context);
  if (!found || found->empty()) return found;
  // A straight way is the shortest.
  if (found->size() == 1) return found;
  // Most are shorter by far than what was found in a hurry. If not, what was looked at in vain is little.
  const double least = distance(from, to), most = arrivals_.back().cost;
  for (const double part : {1.0 / 256, 1.0 / 16, 1.0}) {
    found = search(1, least + part * (most - least) + 4 * slack_.tolerance + 1e-12 * most, context);
    if (!found || !found->empty()) return found;
  }
  return search(1, infinity, context);
}

/// Best first by cost and `weight` times what is left at least; nothing longer than `limit`.
Result<std::vector<TautStretch>> TautSearch::search(double weight, double limit, const Context& context) {
  weight_ = weight, limit_ = limit;
  queue_ = {}, order_ = 0;
  arrivals_.clear(), horizons_.clear();
  reached_.assign(2 * space_.arcs().size(), {});
  arrive({none, 0, 0, none, from_, from_, 0});
  for (std::uint64_t steps = 0; !queue_.empty(); ++steps) {
    if (steps % 1024 == 0 && context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
    const Entry entry = queue_.top();
    queue_.pop();
    if (entry.level >= 0)
      open(entry);
    else if (follow(entry))
      return stretches();
  }
  return std::vector<TautStretch>{};
}

std::vector<TautStretch> TautSearch::stretches() const {
  std::vector<TautStretch> out;
  for (Index a = Index(arrivals_.size() - 1); arrivals_[a].parent != none; a = arrivals_[a].parent) {
    const Arrival& r = arrivals_[a];
    const bool last = r.wheel == goal();
    out.push_back({r.start, r.end, last ? none : r.wheel / 2, !last && clockwise(r.wheel), r.sweep});
  }
  std::reverse(out.begin(), out.end());
  return out;
}

}  // namespace krepl::route
