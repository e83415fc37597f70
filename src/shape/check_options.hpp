#pragma once

#include "krepl/error.hpp"
#include "krepl/network.hpp"
#include "krepl/shape.hpp"

namespace krepl::shape {

/// Options out of range, that do not go together, or that the network has nothing for: ErrorCode::usage.
Status check_options(const Network& network, const ShapeOptions& options);

/// Lines and points do not shrink: ErrorCode::usage that names the feature.
Status check_shrinkable(const Network& network);

}  // namespace krepl::shape
