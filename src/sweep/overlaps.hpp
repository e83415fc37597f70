#pragma once

#include <span>

#include "sweep/predicates.hpp"

namespace krepl::sweep {

/// The outlines laid over each other. Circles about vertices where paths meet stand in several outlines; their arcs are
/// split at each other's ends and their multiplicities added, so that no two curves overlap. O(n log n).
Outline overlay(std::span<const Outline> outlines, Predicates& predicates);

}  // namespace krepl::sweep
