#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "input/route_file.hpp"
#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/terrain.hpp"
#include "verify/obstacle.hpp"
#include "verify/zone_verifier.hpp"

namespace krepl::verify {

struct RouteCheckOptions {
  double radius = 0;     ///< of the disk or ball
  double max_error = 0;  ///< what a format without arcs was allowed
  /// In space: about so many places of the ball along the route at most, where it follows the surface so closely that no
  /// stretch can be proven free; 0: a million.
  std::uint64_t samples = 0;
  double ceiling = std::numeric_limits<double>::infinity();    ///< in space: of the ball's centre
  double max_slope = std::numeric_limits<double>::infinity();  ///< in space: rise over horizontal way, up and down
};

struct RouteReport {
  double radius = 0, length = 0;
  double scale = 0;      ///< S of the accuracy contract: the largest of radius and extent, the route's included
  double tolerance = 0;  ///< 1e-9 S, or 64 steps of the coordinates where that is coarser
  double clearance = 0;  ///< least distance found between the centre's way and the obstacles
  Point nearest;         ///< where the centre is then
  std::size_t pieces = 0, obstacles = 0;
  /// In space: between two places looked at the ball can be nearer by this at most; 0 if all of the route is proven.
  double unproven = 0;
  double climb = 0, steepest = 0;  ///< in space; without vertical take-off and landing
  std::vector<Check> checks;
  bool ok() const {
    for (const Check& c : checks)
      if (!c.ok()) return false;
    return true;
  }
};

/// Whether a disk's centre that follows the route keeps its radius from all lines, points and polygons: the distance of each
/// piece, segment or arc, from each segment of the input in closed form, one by one in extended precision; no tree and no zone.
/// Further: that pieces follow one another, lie outside of all polygons, and that the clearance is not less than the file tells, to
/// R/1000 (parabolas are written as chords). O(pieces x segments); most pairs cost a comparison of boxes.
/// Errors: radius not finite and positive, no obstacle, cancelled.
Result<RouteReport> check_route(const input::RouteRecord& route, const std::vector<InputPart>& parts,
                                const RouteCheckOptions& options, const Context& context = {});

/// Whether a ball's centre that follows the route keeps its radius from the terrain and all below it. The distance changes by no
/// more than the way, so the ball about the middle of a stretch proves all of it or the stretch is halved. Further: ceiling, and
/// slopes but for a vertical first or last stretch. Errors: as above, and a route without heights.
Result<RouteReport> check_flight(const input::RouteRecord& route, const Terrain& terrain, const RouteCheckOptions& options,
                                 const Context& context = {});

}  // namespace krepl::verify
