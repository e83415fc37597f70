#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

#include "kernel/parallel.hpp"
#include "krepl/context.hpp"
#include "krepl/error.hpp"

namespace krepl::free {

/// Error budget, relative to S. Rough distances in double precision: 2^-48 (differences of coordinates 2^-53, normals
/// of triangles that are no slivers 16 times as much, some operations); measured ones: 2^-53.
struct Tolerance {
  explicit Tolerance(double scale) : touch(0x1p-46 * scale), margin(0x1p-44 * scale) {}

  double touch;   ///< what is nearer than that to contact counts as contact
  double margin;  ///< by which the nearest obstacle may seem farther than another one

  /// How far off the slope of a rough distance may be: the direction to the obstacle is off by rounding over distance.
  double slope_error(double distance, double speed) const { return speed * touch / distance; }

  double clearance(double measured) const { return std::abs(measured) <= touch ? 0 : measured; }
};

/// Calls work(i) for all of a batch, each result with its own place.
template <class Work>
Status for_each_place(std::size_t places, std::size_t results, const Context& context, const Work& work) {
  if (places != results)
    return Error{ErrorCode::usage, "there are not as many results as placements", "", "give spans of equal size"};
  kernel::Progress progress(context, places);
  const bool done = kernel::parallel_blocks(context, places, 256, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) work(i);
    progress.add(last - first);
  });
  if (!done || context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  return std::monostate{};
}

/// The first cut on a polyline.
template <class Cut, class Place, class First>
std::optional<Cut> first_of_legs(std::span<const Place> points, const First& first_contact) {
  if (points.size() == 1) return first_contact(points[0], points[0]);
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    if (std::optional<Cut> cut = first_contact(points[i], points[i + 1])) {
      cut->leg = i;
      return cut;
    }
  return std::nullopt;
}

}  // namespace krepl::free
