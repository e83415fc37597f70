#pragma once

#include <vector>

#include "incremental/parts.hpp"

namespace krepl::incremental {

/// Triangles in the monotone order of Asano et al. [javgal2006, section 4.5]: along +y, each after all that are straight
/// below it in the plane, so that what has been added is always bounded above by an x-monotone line. Where triangles
/// overlap, or are each before the other by way of third ones, the lower middle goes first; the union does not depend
/// on it.
std::vector<Index> monotone_order(const Parts& parts);

}  // namespace krepl::incremental
