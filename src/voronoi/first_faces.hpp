#pragma once

#include <vector>

#include "voronoi/glue.hpp"

namespace krepl::voronoi {

/// Computes all faces in double precision, a block of neighbouring sites after the other, in parallel. `borders` and
/// `again` have room for every element; faces that are certainly wrong are marked in the latter. Errors: cancelled; more
/// candidates than allowed (0: any number).
Status build_first_faces(const Sites& sites, const SiteBoxes& boxes, std::uint64_t most_candidates, const Context& context,
                         Borders& borders, std::vector<char>& again, DiagramCounters& counters);

}  // namespace krepl::voronoi
