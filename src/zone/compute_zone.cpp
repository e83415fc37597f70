#include <algorithm>
#include <cmath>
#include <limits>

#include "krepl/zone.hpp"
#include "zone/assembly.hpp"
#include "zone/boundary.hpp"
#include "zone/nesting.hpp"
#include "zone/rings.hpp"

namespace krepl {
namespace {

constexpr double largest_number = 1e18, smallest_radius = 1e-100;

double unit_in_last_place(double x) { return std::nextafter(x, std::numeric_limits<double>::infinity()) - x; }

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

/// Error budget, in terms of S = max(R, extent) and u, the unit in the last place of the largest output coordinate:
///   g: radius enlarged by     max(4 u, 2^-48 S) , so that what comes that close merges     <= 3.6e-15 S
///   vertices moved by         2^-72 extent, in ill-conditioned places only                 <= 2.2e-22 S
///   evaluation of a vertex    a few u                                                      ~ 1e-15 S
///   contraction of pieces     up to 64 g along the boundary, g off it                      <= 2.3e-13 S
/// where u <= 2^-52 S unless the data lies far from its own origin, when u is what the format can hold; g and 64 g are
/// capped at 2^-31 S there. Vertices are evaluated with the nominal radius where that shifts them by at most a quarter
/// of the length below which pieces are contracted.
struct Precision {
  double effective_radius;
  double resolution;
};

Result<Precision> precision_for(const Network& network, double radius) {
  if (!std::isfinite(radius) || radius <= 0) {
    return Error{ErrorCode::usage, "the radius is " + number(radius), "", "give a positive, finite number"};
  }
  const double scale = std::max(radius, network.extent());
  if (scale > largest_number || radius < smallest_radius) {
    return Error{ErrorCode::input, "coordinates or radius are beyond 1e18, or the radius is below 1e-100", "",
                 "scale the input"};
  }
  const double u = std::max(network.resolution(), unit_in_last_place(scale));
  if (radius < 16384 * u) {
    return Error{ErrorCode::usage, "the radius " + number(radius) + " is finer than the coordinates can hold", "",
                 "use at least " + number(16384 * u)};
  }
  const double most = 0x1p-31 * scale;  // half of the contract's 1e-9 S
  const double enlargement = std::min(std::max(4 * u, 0x1p-48 * scale), most);
  return Precision{radius + enlargement, std::max(4 * u, std::min(64 * enlargement, most))};
}

}  // namespace

Result<Zone> compute_zone(std::shared_ptr<const Network> network, const ZoneOptions& options, const Context& context) {
  const auto precision = precision_for(*network, options.radius);
  if (!precision) return precision.error();
  const Error cancelled{ErrorCode::cancelled, "cancelled", "", ""};

  ZoneCounters counters;
  std::optional<zone::Instance> instance(std::in_place, *network, options.radius, precision->effective_radius,
                                         precision->resolution, context);
  std::vector<zone::Piece> pieces;
  {
    const zone::SiteTree tree(*instance, context);
    if (context.cancelled()) return cancelled;
    pieces = zone::uncovered_pieces(*instance, tree, context, counters);
  }
  if (context.cancelled()) return cancelled;
  auto linked = zone::link_pieces(*instance, pieces, context);
  if (!linked) return linked.error();
  pieces = {};
  zone::Rings rings = zone::contract(*instance, std::move(*linked), precision->resolution, context, counters);
  if (network->has_polygons()) rings = zone::drop_rings_inside_polygons(*network, std::move(rings));
  if (context.cancelled()) return cancelled;
  const auto nesting = zone::nest(*instance, rings, context);
  if (!nesting) return nesting.error();
  instance.reset();
  return ZoneAssembly::assemble(std::move(network), options.radius, std::move(rings), *nesting, counters,
                                context);
}

}  // namespace krepl
