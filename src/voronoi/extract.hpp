#pragma once

#include "krepl/error.hpp"
#include "voronoi/diagram.hpp"
#include "zone/rings.hpp"

namespace krepl::voronoi {

/// The boundary at the instance's radius: within every face the site's own, from where it comes in over a link to where
/// it goes out over another. Closed by construction: along a face's border what rises above the radius comes down
/// again, and both sides of a link see the same clearances; ErrorCode::computation if the diagram is not that sound.
/// O(links), single pass.
Result<zone::Rings> extract_rings(const Diagram& diagram, const Instance& instance, const Context& context);

}  // namespace krepl::voronoi
