#pragma once

#include <queue>
#include <unordered_map>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "route/flight_proof.hpp"

namespace krepl::route {

/// An end of a route, relative to the terrain's origin.
struct FlightEnd {
  Point place;
  double height;  ///< where the ball is, or rests
  bool lifts;     ///< takes off or lands straight up and down
};

struct FlightRules {
  FlightEnd from, to;
  double ceiling, max_slope, step;
  bool climb;  ///< what is minimised

  double cost(Point3 a, Point3 b) const;
  /// Never more than the cost of any way.
  double least_cost(Point3 a, Point3 b) const { return cost(a, b); }
  bool slope_allows(Point3 a, Point3 b) const;
};

/// Places in rows and columns and levels of height, and the best way between two ends over them. The ends are columns
/// of their own, joined to the places around them.
class FlightLattice {
 public:
  FlightLattice(const DropCutter& cutter, const FlightRules& rules, FlightProof& proof,
                TerrainRoute::Counters& counters);

  /// Evaluates the surface at all places.
  Status survey(const Context& context);
  /// Points of the best way; empty if there is none. Errors: cancelled; too many nodes.
  Result<std::vector<Point3>> search(const Context& context);

 private:
  using Node = std::uint64_t;  // column * levels + level
  struct Entry {
    double bound, cost;
    Node node, parent;
    bool operator<(const Entry& o) const { return bound != o.bound ? bound > o.bound : node > o.node; }
  };
  struct Known {
    double cost;  ///< of a way that is proven
    Node parent;
    bool settled;
  };
  static constexpr Node none = ~Node{0};

  std::size_t start_column() const { return columns_ * rows_; }
  std::size_t goal_column() const { return columns_ * rows_ + 1; }
  bool is_end(std::size_t column) const { return column >= start_column(); }
  const FlightEnd& end_of(std::size_t column) const { return column == start_column() ? rules_.from : rules_.to; }
  Point place(std::size_t column) const;
  Point3 point(Node node) const;
  bool fixed(std::size_t column) const { return is_end(column) && !end_of(column).lifts; }
  bool allowed(std::size_t column, std::size_t level) const;
  bool clearly_free(Node a, Node b) const;
  void push(Node node, double cost, Node parent);
  void push_all(std::size_t column, Node parent, double cost);
  void expand(Node node, double cost);
  void each_neighbour(std::size_t column, const std::function<void(std::size_t)>& visit) const;

  const DropCutter& cutter_;
  const FlightRules& rules_;
  FlightProof& proof_;
  TerrainRoute::Counters& counters_;
  DropCutter::Raster raster_;
  std::size_t columns_ = 0, rows_ = 0, levels_ = 0;
  double lowest_ = 0, rise_ = 1;
  std::vector<float> floor_, clear_;  // rounded up: of the ball, and of one that covers half of any move
  std::vector<std::vector<std::size_t>> around_end_;
  std::priority_queue<Entry> queue_;
  std::unordered_map<Node, Known> known_;
};

}  // namespace krepl::route
