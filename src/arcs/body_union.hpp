#pragma once

#include "arcs/bodies.hpp"
#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "zone/shaped_rings.hpp"

namespace krepl::arcs {

/// The boundary of the union of all bodies as rings with the union on their left; what is shorter or thinner than
/// `resolution` is contracted. An end without its counterpart is an ErrorCode::computation that names the place.
Result<zone::ShapedRings> body_union(const Bodies& bodies, double resolution, const Context& context,
                                     ZoneCounters& counters);

}  // namespace krepl::arcs
