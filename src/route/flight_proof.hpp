#pragma once

#include <map>
#include <span>

#include "krepl/drop_cutter.hpp"
#include "krepl/terrain_route.hpp"

namespace krepl::route {

/// Routes keep this part of the radius more away from the surface than they need, where they follow it: proofs of
/// stretches that touch it all along would take a million times as many steps.
inline constexpr double hover = 1e-3;

/// Proofs that a ball can move straight between two places over a terrain. Coordinates are relative to the terrain's
/// origin.
class FlightProof {
 public:
  /// `tolerance`: what the proven clearance may be less than the radius.
  FlightProof(const DropCutter& cutter, double tolerance, TerrainRoute::Counters& counters)
      : cutter_(cutter), radius_(cutter.radius()), tolerance_(tolerance), counters_(counters) {}

  double tolerance() const { return tolerance_; }
  /// Where the ball rests; minus infinity where it touches nothing.
  double rest(Point p) const { return cutter_.at(p).height; }
  /// True if a ball of this radius about a place is free.
  bool free(Point3 p, double radius);
  /// True if the ball (of another radius, if one is given) is proven free on the whole stretch. False also where it
  /// touches the surface all along and would have to be proven place by place; at single places it may touch.
  bool free(Point3 a, Point3 b, double radius);
  bool free(Point3 a, Point3 b) { return free(a, b, radius_ - tolerance_); }
  /// True if all stretches of a polyline are.
  bool free(std::span<const Point3> points, double radius);
  /// Largest clearance that could be proven for a polyline that is free, to a ten thousandth of the radius.
  double clearance(std::span<const Point3> points);

 private:
  bool free_inside(Point3 a, Point3 b, double radius, int& patience);
  double height(Point p, double radius);

  const DropCutter& cutter_;
  double radius_, tolerance_;
  TerrainRoute::Counters& counters_;
};

}  // namespace krepl::route
