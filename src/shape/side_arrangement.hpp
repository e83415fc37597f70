#pragma once

#include <optional>
#include <span>
#include <vector>

#include "kernel/box_tree.hpp"
#include "krepl/context.hpp"
#include "krepl/network.hpp"
#include "zone/instance.hpp"

namespace krepl::shape {

using zone::Index;
using zone::none;

/// A side of a polygon ring as it runs, between vertices of the network.
struct RingSide {
  Index from, to;
  Index part;
  std::int64_t feature;
};

/// The sides of a ring, without those of no length.
void append_sides(const Network& network, Index part, std::vector<RingSide>& out);

/// Sides cut where they meet, so that they share ends only, or coincide.
struct SideArrangement {
  struct Fragment {
    Index from, to;  // of place
    Index side;      // of the sides given
  };
  std::vector<Point> place;     // relative to the network's origin
  std::vector<Point> snapped;   // the same on the integer grid where all decisions are exact
  std::vector<Index> original;  // per place the vertex of the network; none where sides cross
  std::vector<Fragment> fragments;
};

/// Places closer than 2^-50 of the extent become one. Nothing if cancelled.
std::optional<SideArrangement> arrange(const Network& network, std::span<const RingSide> sides, const Context& context);

/// Fragments that coincide, whichever way they run, one after the other: groups[i] .. groups[i+1) of order.
struct Coinciding {
  std::vector<Index> order, groups;
};
Coinciding group_coinciding(const SideArrangement& arrangement);

/// Which features' fragments a ray to the left meets; exact.
class RayToTheLeft {
 public:
  RayToTheLeft(const SideArrangement& arrangement, std::span<const RingSide> sides);
  /// The features that hold, by the even-odd rule, what is just left of the middle of the fragment (just above it if it
  /// is horizontal); sorted.
  std::vector<std::int64_t> holding(Index fragment) const;

 private:
  const SideArrangement& arrangement_;
  std::span<const RingSide> sides_;
  kernel::BoxTree tree_;
};

}  // namespace krepl::shape
