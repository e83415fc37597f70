#pragma once

#include <memory>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/shape.hpp"

namespace krepl::shape {

/// The part of a zone of lines that lies on one side of them. Options are checked already.
Result<Zone> one_sided(std::shared_ptr<const Network> network, const ShapeOptions& options, const Context& context);

}  // namespace krepl::shape
