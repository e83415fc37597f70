#pragma once

#include "sweep/predicates.hpp"
#include "zone/gaps.hpp"

namespace krepl::sweep {

/// The boundary as pieces of elements, sorted by element: arcs that were cut at extremes of their circles are put
/// together again. A curve whose ends do not belong to its element gives a piece that links to nothing. O(n log n).
std::vector<zone::Piece> pieces_of(const Outline& boundary, const Geometry& geometry);

}  // namespace krepl::sweep
