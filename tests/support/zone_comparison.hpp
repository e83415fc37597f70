#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "krepl/zone.hpp"

namespace krepl::test {

/// How two zones of one input and radius differ in what the accuracy statement promises: rings, holes, area (1e-9
/// relative); nothing if they do not.
inline std::optional<std::string> difference(const Zone& a, const Zone& b) {
  const auto counts = [](const Zone& z) {
    return std::to_string(z.ring_count()) + " rings (" + std::to_string(z.hole_count()) + " holes, " +
           std::to_string(z.polygon_count()) + " polygons)";
  };
  if (counts(a) != counts(b)) return counts(a) + " against " + counts(b);
  const double first = a.area(), second = b.area();
  if (!(std::abs(first - second) <= 1e-9 * first))
    return "area " + std::to_string(first) + " against " + std::to_string(second);
  return std::nullopt;
}

}  // namespace krepl::test
