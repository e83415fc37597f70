#pragma once

#include <vector>

#include "arcs/side_arrangement.hpp"
#include "krepl/error.hpp"

namespace krepl::arcs {

/// A feature's rings, cut where they meet.
struct FeatureRings {
  SideArrangement arrangement;
  std::vector<Index> collapsed;  // rings without sides

  bool overlaps() const { return arrangement.groups().size() != arrangement.fragments().size() + 1; }
};

/// Errors: cancelled.
Result<FeatureRings> take_apart(const CurveNetwork& network, const std::vector<Index>& rings, const Context& context);

}  // namespace krepl::arcs
