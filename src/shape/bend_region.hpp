#pragma once

#include <optional>
#include <vector>

#include "kernel/vectors.hpp"
#include "krepl/shape.hpp"
#include "zone/instance.hpp"

namespace krepl::shape {

/// What a zone with bevelled or mitred joins holds of the places nearest to a bend's vertex: those within one line (a bevel) or two (a
/// mitre), which end where the offsets of the two segments do. Places are relative to the network's origin.
class BendRegion {
 public:
  /// Places q with normal * (q - vertex) <= distance; the line is the offset of `side`, or the bevel's.
  struct Border {
    Point normal;
    double distance;
    zone::Index side;  // none: a bevel
  };

  /// None where the join is round: by choice, or as the bend is below 2^-20 and a mitre would be within rounding of the arc.
  static std::optional<BendRegion> at(const zone::Instance& instance, zone::Index vertex, const ShapeOptions& options);

  Point vertex() const { return vertex_; }
  const std::vector<Border>& borders() const { return borders_; }
  /// How far a place is beyond the borders; below zero inside.
  double excess(Point place) const;
  /// The borders from `from` counter-clockwise to `to`, which lie on them: the piece of each, and where it starts.
  struct Stretch {
    const Border& border;
    Point start, end;
  };
  std::vector<Stretch> stretches(Point from, Point to) const;

 private:
  BendRegion(Point vertex, std::vector<Border> borders) : vertex_(vertex), borders_(std::move(borders)) {}

  Point vertex_;
  std::vector<Border> borders_;  // counter-clockwise
};

}  // namespace krepl::shape
