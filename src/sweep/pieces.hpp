#pragma once

#include "sweep/predicates.hpp"
#include "zone/gaps.hpp"

namespace krepl::sweep {

/// The boundary as pieces of elements, in the order that uncovered_pieces has: by element, then along it. Arcs that
/// were cut at extremes of their circles are put together again. A curve whose ends do not belong to its element gives
/// a piece that links to nothing. O(n log n).
std::vector<zone::Piece> pieces_of(const Outline& boundary, Predicates& predicates);

}  // namespace krepl::sweep
