#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "input/parts.hpp"
#include "krepl/context.hpp"

namespace krepl::input {

/// Coordinate system of the data and where they should go.
struct ProjectionRequest {
  std::optional<OGRSpatialReference> from;  ///< nothing: a plane of unknown place
  std::string to_crs;                       ///< empty: stay, which is an error for degrees
  std::function<std::string(std::int64_t)> place;  ///< names a feature in errors
};

/// Projects the parts in place, vertex by vertex, if asked to. Returns the coordinate system that they are in then.
/// `auto` takes the UTM zone of the data's centre where they fit it (6 degrees wide, between 80 S and 84 N), otherwise an
/// azimuthal equidistant projection around the centre; a note says which.
Result<std::optional<OGRSpatialReference>> project(Parts& parts, const ProjectionRequest& request,
                                                   std::vector<std::string>& notes, const Context& context);

/// The shortest interval of longitude that holds all of the given ones, also across 180 degrees: west end and width.
/// Exact to 0.05 degrees. Precondition: not empty.
struct LongitudeRange {
  double west = 0, width = 0;
};
LongitudeRange longitude_range(const std::vector<double>& longitudes);

}  // namespace krepl::input
