#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "krepl/network.hpp"
#include "route/packed_tree.hpp"

namespace krepl::route {

/// An arc of a circle, by the angles of its ends: counter-clockwise from `from` over `span`.
struct ArcShape {
  Point center;
  double radius, from, span;
};

/// The segments and isolated vertices of a network, for questions about distance. Coordinates are relative to the
/// network's origin.
class Obstacles {
 public:
  explicit Obstacles(const Network& network);

  struct Nearest {
    double distance = std::numeric_limits<double>::infinity();
    Point at;
    std::uint32_t item = 0;  ///< below segments().size(): a segment; else the isolated vertex item - segments().size()
  };
  Nearest nearest(Point p) const;
  /// Distance of segment ab, if it is below `limit`; else `limit`.
  double nearest_to_segment(Point a, Point b, double limit) const;
  /// True if some obstacle is nearer to segment ab than `clearance`.
  bool any_within(Point a, Point b, double clearance) const;
  /// Visits segments and points, their ends given, by growing distance of their boxes from p, until visit(distance, a,
  /// b) returns false. Only those whose boxes, and those around them, fulfil a condition: is_near(distance, box).
  void each_by_distance(Point p, const std::function<bool(double, Point, Point)>& visit,
                        const std::function<bool(double, const Box&)>& is_near) const;
  double nearest_to_arc(const ArcShape& arc, double limit) const;

  /// The feature of a polygon that holds p in its inside (even-odd rule of each feature), if any does.
  std::optional<std::int64_t> polygon_around(Point p) const;
  Network::Source source(std::uint32_t item) const;
  const Network& network() const { return network_; }

 private:
  struct Ends {
    Point a, b;
  };
  Ends ends(std::size_t item) const;
  std::vector<Box> boxes() const;

  const Network& network_;
  std::vector<std::uint32_t> isolated_;
  PackedTree tree_;
};

}  // namespace krepl::route
