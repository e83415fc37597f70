#pragma once

#include <cstdint>
#include <memory>
#include <queue>
#include <unordered_map>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/route.hpp"
#include "route/free_space.hpp"
#include "route/horizon.hpp"
#include "route/tangent.hpp"

namespace krepl::route {

/// A taut string: tangents, each but the last ending where the arc of the next wheel begins.
struct TautStretch {
  Point start, end;   ///< of the tangent
  std::uint32_t arc;  ///< it arrives at; none at the goal
  bool clockwise;     ///< how the string turns about that arc
  double sweep;       ///< angle it turned about the arc it came from
};

/// Best first search for the shortest taut string between two free places.
///
/// A directed arc is an arc with the sense in which a string turns about it; places on it are told by the angle turned
/// since its start in that sense. Every arrival at a directed arc draws tangents from what lies ahead of it, by opening
/// the tree over all arcs node by node in the order of a lower bound of the whole route. Tangents wait in the same
/// queue; only when one comes up is it tested against the obstacles.
///
/// First in a hurry, with the way that is left counting for more than it is: that soon finds some string. Then for the
/// shortest one, and nothing is looked at that cannot be part of a shorter one than that.
class TautSearch {
 public:
  TautSearch(const FreeSpace& space, const Obstacles& obstacles, double radius, Slack slack);

  /// The stretches from `from` to `to`; empty if there is no way. Errors: cancelled.
  Result<std::vector<TautStretch>> run(Point from, Point to, const Context& context);

  /// Of all that was looked at.
  const RouteCounters& counters() const { return counters_; }

 private:
  using Index = std::uint32_t;
  static constexpr Index none = ~Index{0};

  struct Arrival {
    Index wheel;   ///< directed arc; none: the start
    double at;     ///< angle along it
    double cost;   ///< of the way here
    Index parent;  ///< arrival
    Point start, end;
    double sweep;
  };
  /// What waits: a node of the tree to be looked at from an arrival, or a tangent.
  struct Entry {
    double bound;  ///< of the whole route
    Index order;   ///< of making; decides ties
    Index arrival;
    Index target;       ///< node of the tree, or directed arc (goal() for the goal)
    std::int8_t level;  ///< of the node; -1: a tangent
    bool operator<(const Entry& o) const { return bound != o.bound ? bound > o.bound : order > o.order; }
  };
  struct Link {
    Tangent tangent;
    double sweep, at, cost;
    double leaving;  ///< angle at which it leaves
  };

  Result<std::vector<TautStretch>> search(double weight, double limit, const Context& context);
  Index goal() const { return Index(2 * space_.arcs().size()); }
  const FreeArc& arc(Index wheel) const { return space_.arcs()[wheel / 2]; }
  static bool clockwise(Index wheel) { return wheel % 2 == 1; }
  static double sense(Index wheel) { return clockwise(wheel) ? -1 : 1; }
  Wheel wheel(Index w) const;
  std::optional<double> along(Index wheel, Point normal) const;
  std::vector<Box> boxes() const;
  const Horizon& horizon(const Arrival& arrival);
  double left(double away) const { return weight_ * away; }
  std::optional<Link> link(const Arrival& from, Index target) const;
  bool visible(const Arrival& from, Index target, const Tangent& tangent);
  bool dominated(Index wheel, double at, double cost) const;
  void arrive(const Arrival& arrival);
  void push(double bound, Index arrival, Index target, int level);
  void push_tangent(Index arrival, Index target);
  void open(const Entry& entry);
  bool follow(const Entry& entry);
  std::vector<TautStretch> stretches() const;

  const FreeSpace& space_;
  const Obstacles& obstacles_;
  const double radius_;
  const Slack slack_;
  const double angle_slack_;
  PackedTree tree_;
  Point from_, to_;
  std::vector<Arrival> arrivals_;
  std::unordered_map<Index, std::unique_ptr<Horizon>> horizons_;  // by directed arc
  struct Reached {
    double at, cost;
  };
  std::vector<std::vector<Reached>> reached_;  // per directed arc
  std::priority_queue<Entry> queue_;
  double weight_ = 1;                                          // of the way that is left
  double limit_ = std::numeric_limits<double>::infinity();  // of a route's length
  std::unordered_map<std::uint64_t, bool> visible_;
  Index order_ = 0;
  RouteCounters counters_;
};

}  // namespace krepl::route
