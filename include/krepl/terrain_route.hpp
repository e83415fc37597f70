#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/drop_cutter.hpp"
#include "krepl/error.hpp"
#include "krepl/point.hpp"

namespace krepl {

/// Where a route over a terrain starts or arrives, in absolute coordinates.
struct TerrainRouteEnd {
  Point place;
  /// Of the ball's centre. Not given: on the offset surface, that is where the ball rests; the route then takes off and
  /// lands straight up and down as far as it has to, and that stretch is exempt from max_slope.
  std::optional<double> height;
};

struct TerrainRouteOptions {
  enum class Minimise : std::uint8_t {
    length,  ///< length in space
    climb    ///< sum of all rises; of routes with equal climb the shorter (length counts a thousandth)
  };

  TerrainRouteEnd from, to;
  double ceiling = std::numeric_limits<double>::infinity();    ///< no part of the route is higher (the ball's centre)
  double max_slope = std::numeric_limits<double>::infinity();  ///< rise over horizontal way, up and down; > 0
  Minimise minimise = Minimise::length;
  /// Distance of the lattice that is searched, > 0; 0: so that it has some 10 000 places.
  double step = 0;
};

/// A way of a ball's centre over a terrain: a polyline in space.
struct TerrainRoute {
  double radius = 0;
  std::vector<Point3> points;  ///< absolute; two or more
  double length = 0;
  double climb = 0;           ///< sum of all rises
  double steepest = 0;        ///< largest slope but for vertical take-off and landing
  double lattice_length = 0;  ///< of the route found in the lattice, before it was shortened
  /// Proven: nowhere is the terrain nearer. At least R - 1e-9 S.
  double clearance = 0;

  struct Counters {
    std::uint64_t places = 0, levels = 0;  ///< of the lattice
    std::uint64_t visited = 0;             ///< nodes settled
    std::uint64_t proofs = 0;              ///< stretches proven free or found not to be
    std::uint64_t drops = 0;               ///< lowered balls in these proofs
  } counters;
};

/// A route of a ball of the cutter's radius over its terrain, everything below the surface being solid.
///
/// Every straight stretch is proven free, not sampled: the part of the swept ball about a stretch of half length l lies
/// in the ball of radius sqrt(R^2 + l^2) about its middle, and that ball is free if the drop cutter of this radius
/// rests no higher; where it is not, the stretch is halved. So the clearance that is returned holds at every place of
/// the route, within 1e-9 S. The route stays over the terrain (places where the ball rests on something), as seen at
/// half steps of the lattice.
///
/// The route is the best one in a lattice of places and levels (16 directions; A*), made better by leaving out points
/// and cutting corners as long as what is left is proven: near a shortest route, not proven to be one. Passages that
/// are narrower than the lattice's step may be missed.
///
/// Errors: options out of range, or a cutter that is no ball (usage); an end that is not finite, not over the terrain, or where the ball overlaps
/// the terrain (how deep); a ceiling below an end; no route in the lattice; more than ten million nodes; cancelled.
Result<TerrainRoute> compute_terrain_route(const DropCutter& cutter, const TerrainRouteOptions& options,
                                           const Context& context = {});

}  // namespace krepl
