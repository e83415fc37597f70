#pragma once

#include "krepl/error.hpp"
#include "voronoi/diagram.hpp"
#include "zone/rings.hpp"

namespace krepl::voronoi {

/// A stretch of the boundary at the instance's radius within one face: the link it comes in by, rising above the radius,
/// and the one it leaves by. Link none: a full circle.
struct Entry {
  Index face, link, exit;
};

/// All such stretches, in order of faces and, within them, of links. An exit of none where the diagram is not sound.
std::vector<Entry> find_entries(const Diagram& diagram, const Instance& instance, const Context& context);

/// The boundary at the instance's radius: within every face the site's own, from where it comes in over a link to where
/// it goes out over another. Closed by construction: along a face's border what rises above the radius comes down
/// again, and both sides of a link see the same clearances; ErrorCode::computation if the diagram is not that sound.
/// O(links), single pass.
Result<zone::Rings> extract_rings(const Diagram& diagram, const Instance& instance, const Context& context);

}  // namespace krepl::voronoi
