#include "route/flight_lattice.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernel/outward_rounding.hpp"
#include "kernel/vectors.hpp"

namespace krepl::route {

using namespace vectors;

namespace {

constexpr std::size_t most_levels = 200, most_limited_levels = 5000, most_nodes = 10'000'000;
/// Sixteen directions.
constexpr std::array<std::array<int, 2>, 16> moves{{{1, 0},
                                                    {-1, 0},
                                                    {0, 1},
                                                    {0, -1},
                                                    {1, 1},
                                                    {1, -1},
                                                    {-1, 1},
                                                    {-1, -1},
                                                    {2, 1},
                                                    {2, -1},
                                                    {-2, 1},
                                                    {-2, -1},
                                                    {1, 2},
                                                    {1, -2},
                                                    {-1, 2},
                                                    {-1, -2}}};
/// With length of so much less weight than climb.
constexpr double length_of_climb = 1e-3;

}  // namespace

double FlightRules::cost(Point3 a, Point3 b) const {
  const double size = distance(a, b);
  return climb ? std::max(b.z - a.z, 0.0) + length_of_climb * size : size;
}

bool FlightRules::slope_allows(Point3 a, Point3 b) const {
  const double rise = std::abs(b.z - a.z), way = std::hypot(b.x - a.x, b.y - a.y);
  return rise <= max_slope * way * (1 + 1e-12) || rise == 0 || std::isinf(max_slope);
}

FlightLattice::FlightLattice(const DropCutter& cutter, const FlightRules& rules, FlightProof& proof,
                             TerrainRoute::Counters& counters)
    : cutter_(cutter), rules_(rules), proof_(proof), counters_(counters) {
  const Point3 low = cutter.terrain().lowest(), high = cutter.terrain().highest();
  columns_ = std::size_t((high.x - low.x) / rules.step) + 1, rows_ = std::size_t((high.y - low.y) / rules.step) + 1;
  raster_ = {{low.x, low.y}, rules.step, rules.step, columns_, rows_};
}

Status FlightLattice::survey(const Context& context) {
  const std::size_t count = columns_ * rows_;
  std::vector<DropCutter::Contact> contacts(count);
  // What covers half of any move, one level up or down included.
  const double range = cutter_.terrain().highest().z - cutter_.terrain().lowest().z + 2 * cutter_.radius();
  rise_ = std::isinf(rules_.max_slope) ? rules_.step / 2 : rules_.max_slope * rules_.step;
  rise_ = std::max(rise_, range / double(std::isinf(rules_.max_slope) ? most_levels : most_limited_levels));
  const double half_move = 0.5 * std::hypot(std::sqrt(5.0) * rules_.step, rise_);
  const Result<DropCutter> covering = cutter_.with_radius(std::hypot(cutter_.radius(), half_move));
  for (const DropCutter* cutter : {&cutter_, covering ? &*covering : nullptr}) {
    std::vector<float>& heights = cutter == &cutter_ ? floor_ : clear_;
    heights.assign(count, std::numeric_limits<float>::infinity());
    if (cutter == nullptr) continue;
    if (Status done = cutter->at(raster_, contacts, context); !done) return done;
    for (std::size_t i = 0; i < count; ++i)
      if (contacts[i].touches()) heights[i] = kernel::float_above(contacts[i].height + hover * cutter_.radius());
  }
  double highest = std::max(rules_.from.height, rules_.to.height);
  for (std::size_t i = 0; i < count; ++i)
    if (std::isfinite(floor_[i])) highest = std::max(highest, double(floor_[i]));
  // A level is the ceiling, so that what fits below it is found.
  const double top = std::min(rules_.ceiling, highest + rise_);
  lowest_ = std::min(cutter_.terrain().lowest().z, std::min(rules_.from.height, rules_.to.height));
  levels_ = std::size_t(std::max(0.0, std::ceil((top - lowest_) / rise_))) + 1;
  lowest_ = top - double(levels_ - 1) * rise_;
  counters_.places = count, counters_.levels = levels_;
  around_end_.assign(2, {});
  for (std::size_t end = 0; end < 2; ++end)
    for (std::size_t c = 0; c < count; ++c) {
      const Point p = place(c), q = end_of(start_column() + end).place;
      if (std::hypot(p.x - q.x, p.y - q.y) <= 2.3 * rules_.step) around_end_[end].push_back(c);
    }
  return std::monostate{};
}

Point FlightLattice::place(std::size_t column) const {
  return is_end(column) ? end_of(column).place : raster_.place(column % columns_, column / columns_);
}

Point3 FlightLattice::point(Node node) const {
  const std::size_t column = node / levels_;
  const Point p = place(column);
  return {p.x, p.y, fixed(column) ? end_of(column).height : lowest_ + double(node % levels_) * rise_};
}

bool FlightLattice::allowed(std::size_t column, std::size_t level) const {
  if (fixed(column)) return level == 0;
  const double floor = is_end(column) ? end_of(column).height + hover * cutter_.radius() : double(floor_[column]);
  return lowest_ + double(level) * rise_ >= floor;
}

/// Each half of a move lies in the covering ball about its end.
bool FlightLattice::clearly_free(Node a, Node b) const {
  const std::size_t p = a / levels_, q = b / levels_;
  if (p == q) return true;
  return !is_end(p) && !is_end(q) && point(a).z >= double(clear_[p]) && point(b).z >= double(clear_[q]);
}

/// A way that is no cheaper than one that is proven need not wait; a cheaper one waits until it comes up before it is proven.
void FlightLattice::push(Node node, double cost, Node parent) {
  const auto known = known_.find(node);
  if (known != known_.end() && (known->second.settled || known->second.cost <= cost)) return;
  if (parent == none || clearly_free(parent, node)) known_[node] = {cost, parent, false};
  const Point3 goal{rules_.to.place.x, rules_.to.place.y, rules_.to.height};
  queue_.push({cost + rules_.least_cost(point(node), goal), cost, node, parent});
}

void FlightLattice::each_neighbour(std::size_t column, const std::function<void(std::size_t)>& visit) const {
  if (is_end(column)) {
    for (std::size_t c : around_end_[column - start_column()]) visit(c);
    const Point a = place(column), b = place(start_column() + goal_column() - column);
    if (std::hypot(a.x - b.x, a.y - b.y) <= 2.3 * rules_.step) visit(start_column() + goal_column() - column);
    return;
  }
  const auto x = std::ptrdiff_t(column % columns_), y = std::ptrdiff_t(column / columns_);
  for (const auto& [dx, dy] : moves) {
    const std::ptrdiff_t u = x + dx, v = y + dy;
    if (u >= 0 && v >= 0 && u < std::ptrdiff_t(columns_) && v < std::ptrdiff_t(rows_))
      visit(std::size_t(v) * columns_ + std::size_t(u));
  }
  const auto& goal = around_end_[1];
  if (std::binary_search(goal.begin(), goal.end(), column)) visit(goal_column());
}

/// To the levels of a column that the slope lets one reach: up to two up or down.
void FlightLattice::push_all(std::size_t column, Node parent, double cost) {
  const Point3 from = point(parent);
  const auto near = std::ptrdiff_t(std::lround((from.z - lowest_) / rise_));
  const std::ptrdiff_t reach = fixed(column) ? 0 : is_end(parent / levels_) ? 4 : 1;
  for (std::ptrdiff_t level = fixed(column) ? 0 : near - reach; level <= (fixed(column) ? 0 : near + reach); ++level) {
    if (level < 0 || level >= std::ptrdiff_t(levels_) || !allowed(column, std::size_t(level))) continue;
    const Node node = Node(column) * levels_ + Node(level);
    const Point3 to = point(node);
    if (from.x == to.x && from.y == to.y && !fixed(column)) continue;
    if (rules_.slope_allows(from, to)) push(node, cost + rules_.cost(from, to), parent);
  }
}

void FlightLattice::expand(Node node, double cost) {
  const std::size_t column = node / levels_, level = node % levels_;
  each_neighbour(column, [&](std::size_t other) { push_all(other, node, cost); });
  // Straight up and down: at ends that lift, and anywhere if there is no limit to the slope.
  const bool vertical = !fixed(column) && (is_end(column) || std::isinf(rules_.max_slope));
  for (const int by : {-1, 1}) {
    if (!vertical || (by < 0 && level == 0) || (by > 0 && level + 1 == levels_)) continue;
    if (!allowed(column, level + std::size_t(by))) continue;
    const Node other = node + Node(by);
    push(other, cost + rules_.cost(point(node), point(other)), node);
  }
}

Result<std::vector<Point3>> FlightLattice::search(const Context& context) {
  const Point3 from{rules_.from.place.x, rules_.from.place.y, rules_.from.height};
  const Point3 to{rules_.to.place.x, rules_.to.place.y, rules_.to.height};
  for (std::size_t level = 0; level < (rules_.from.lifts ? levels_ : 1); ++level) {
    const Node node = Node(start_column()) * levels_ + level;
    if (allowed(start_column(), level)) push(node, rules_.from.lifts ? rules_.cost(from, point(node)) : 0, none);
  }
  for (std::uint64_t steps = 0; !queue_.empty(); ++steps) {
    if (steps % 1024 == 0 && context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
    const Entry entry = queue_.top();
    queue_.pop();
    const auto known = known_.find(entry.node);
    if (known != known_.end() && (known->second.settled || known->second.cost < entry.cost)) continue;
    if (known == known_.end() || known->second.cost > entry.cost) {
      if (!proof_.free(point(entry.parent), point(entry.node))) continue;
    }
    known_[entry.node] = {entry.cost, entry.parent, true};
    if (++counters_.visited > most_nodes)
      return Error{ErrorCode::computation, "the search has visited ten million nodes", "", "use a larger --step"};
    if (entry.node / levels_ == goal_column()) {
      std::vector<Point3> points;
      if (point(entry.node) != to) points.push_back(to);
      for (Node n = entry.node; n != none; n = known_[n].parent) points.push_back(point(n));
      if (points.back() != from) points.push_back(from);
      std::reverse(points.begin(), points.end());
      return points;
    }
    expand(entry.node, entry.cost);
  }
  return std::vector<Point3>{};
}

}  // namespace krepl::route
