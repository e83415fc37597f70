#include "zone/precision.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace krepl::zone {
namespace {

constexpr double largest_number = 1e18, smallest_radius = 1e-100;

double unit_in_last_place(double x) { return std::nextafter(x, std::numeric_limits<double>::infinity()) - x; }

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

}  // namespace

Result<Precision> precision_for(const Network& network, double radius) {
  return precision_for(network, radius, radius);
}

Result<Precision> precision_for(const Network& network, double least, double radius) {
  return precision_for(network.extent(), network.resolution(), least, radius);
}

Result<Precision> precision_for(double extent, double resolution, double least, double radius) {
  for (const double r : {least, radius}) {
    if (!std::isfinite(r) || r <= 0) {
      return Error{ErrorCode::usage, "the radius is " + number(r), "", "give a positive, finite number"};
    }
  }
  const double scale = std::max(radius, extent);
  if (scale > largest_number || least < smallest_radius) {
    return Error{ErrorCode::input, "coordinates or radius are beyond 1e18, or the radius is below 1e-100", "",
                 "scale the input"};
  }
  const double u = std::max(resolution, unit_in_last_place(scale));
  if (least < 16384 * u) {
    return Error{ErrorCode::usage, "the radius " + number(least) + " is finer than the coordinates can hold", "",
                 "use at least " + number(16384 * u)};
  }
  const double most = 0x1p-31 * scale;  // half of the contract's 1e-9 S
  const double enlargement = std::min(std::max(4 * u, 0x1p-48 * scale), most);
  return Precision{radius + enlargement, std::max(4 * u, std::min(64 * enlargement, most))};
}

Status check_part_radii(const Network& network, std::span<const double> part_radii) {
  if (part_radii.size() != network.part_count()) {
    return Error{ErrorCode::usage,
                 "there are " + std::to_string(part_radii.size()) + " radii for " + std::to_string(network.part_count()) +
                     " parts",
                 "", "give one radius for each part"};
  }
  for (const double radius : part_radii) {  // comparisons would overlook one that is not a number
    if (!(radius > 0)) return precision_for(network, radius).error();
  }
  return std::monostate{};
}

}  // namespace krepl::zone
