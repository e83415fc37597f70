#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/network.hpp"
#include "krepl/point.hpp"

namespace krepl {

/// What a route is to be best at.
enum class RoutePreference : std::uint8_t {
  /// The shortest of all routes whose clearance is at least R + weight * (W - R), where W is the clearance of the
  /// widest
  /// route. Weight 0: the shortest route of the disk; weight 1: the shortest of the widest routes. Where an end has
  /// less
  /// clearance than that, the route leaves it straight away from the nearest obstacle until it has it.
  length,
  /// The route on the medial axis whose least clearance is largest, and among those the shortest on the axis. It leaves
  /// the ends straight away from the nearest obstacle, so that clearance only grows until the axis is reached. The axis
  /// is that of the obstacles and of a frame about obstacles and ends, as far away as they are wide.
  clearance
};

struct RouteOptions {
  double radius = 0;  ///< of the disk: finite and positive, in the unit of the coordinates
  Point from, to;     ///< where the centre starts and arrives, absolute coordinates
  RoutePreference prefer = RoutePreference::length;
  double weight = 0;  ///< prefer == length only: in [0, 1]
};

/// What the search cost. Printed by `krepl --verbose`.
struct RouteCounters {
  std::uint64_t arcs = 0;              ///< of the boundary of free space
  std::uint64_t tangents = 0;          ///< drawn between arcs or ends
  std::uint64_t visibility_tests = 0;  ///< of them, tested against the obstacles
  std::uint64_t arrivals = 0;          ///< ways to reach an arc that were followed further
};

/// A way of a disk's centre between two places: pieces that follow one another, in absolute coordinates.
struct Route {
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  enum class Kind : std::uint8_t { line, arc, parabola };

  struct Piece {
    Kind kind = Kind::line;
    Point start, end;
    Point center;                  ///< arcs: what they turn about; parabolas: their focus
    Point control;                 ///< parabolas: where the tangents at both ends meet (Bezier's middle point)
    bool clockwise = false;        ///< arcs only: sense from start to end, less than a full turn
    std::uint32_t vertex = none;   ///< arcs and parabolas: the vertex of the network at center
    std::uint32_t segment = none;  ///< parabolas: the segment whose line is the directrix
    double length = 0;
    double clearance = 0;  ///< least distance from the obstacles; infinite where there are none
  };

  double radius = 0;       ///< of the disk
  double turn_radius = 0;  ///< of the arcs: R, or more where clearance was asked for
  double length = 0;
  double clearance = std::numeric_limits<double>::infinity();  ///< least of all pieces
  double widest = 0;          ///< clearance of the widest route, the ends' own apart; 0 where it was not asked for
  std::vector<Piece> pieces;  ///< one line of length zero if the ends coincide
  RouteCounters counters;
};

/// A route of a disk of radius R among the lines, points and filled polygons of a network: by default the shortest path
/// in the true free space, made of common tangents of circles about vertices and of arcs of these circles (taut
/// string).
///
/// The disk may touch obstacles: a gap 2R wide lets it through, and ends may lie on the boundary of free space.
/// Decisions are those of free space at a radius smaller by 2^-44 S (or 16 steps of the coordinates, if they are
/// coarser), so nothing closer to the limit is told apart; every piece returned has been measured against all obstacles
/// and keeps R within 1e-9 S. Of several routes of equal length one is returned, always the same.
///
/// Errors: radius or weight out of range (usage); an end that is not finite; an end where the disk overlaps an obstacle
/// (which feature, and how deep); ends in different parts of free space (a disk cannot get from one to the other);
/// cancelled; what compute_zone reports.
///
/// Search best first (A*) over tangents drawn on demand: a node of the tree over arcs is opened only if a route through
/// it could be shorter than those at hand. Expected cost far below the O(n^2 log n) of the whole visibility graph,
/// which is also the worst case. [pocchiola-vegter1996 for what such graphs are; hart-nilsson-raphael1968.]
Result<Route> compute_route(std::shared_ptr<const Network> network, const RouteOptions& options,
                            const Context& context = {});

}  // namespace krepl
