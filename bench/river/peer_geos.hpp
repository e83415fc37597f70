#pragma once

#include <optional>

#include "../measure.hpp"
#include "../zone/lines.hpp"

namespace bench {

/// GEOS cuts lines where they meet (GEOSNode) and joins them again between the nodes (GEOSLineMerge): reaches without
/// direction, order or hierarchy. Nothing if it fails.
struct Reaches {
  Measured measured;
  std::size_t count;
};
std::optional<Reaches> reaches_by_geos(const Lines& lines);

}  // namespace bench
