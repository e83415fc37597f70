#pragma once

#include "krepl/drop_cutter.hpp"
#include "terrain/drop_cutter_search.hpp"

namespace krepl::drop {

/// From the highest feature to the contact: computes the touched point, and goes down to the edge or vertex of the
/// feature that the point lies on. `part` is the search's triangle, `extent` the largest coordinate.
template <class Search>
DropCutter::Contact settle(const Search& search, const Part& part, double extent);

}  // namespace krepl::drop
