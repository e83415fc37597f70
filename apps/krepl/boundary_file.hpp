#pragma once

#include <string>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/mill.hpp"

namespace krepl::app {

/// The polygons of a vector file of any kind, as the boundary of tool paths: a polygon for each feature. Errors: those
/// of reading networks; a feature that is a line or a point.
Result<MillBoundary> read_boundary(const std::string& path, const Context& context);

}  // namespace krepl::app
