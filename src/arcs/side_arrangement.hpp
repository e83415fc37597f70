#pragma once

#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "arcs/ring_side.hpp"
#include "kernel/box_tree.hpp"
#include "krepl/context.hpp"
#include "krepl/curve_network.hpp"

namespace krepl::arcs {

/// Sides cut where they meet, so that they share ends only, or coincide; arcs also where they are highest and lowest,
/// so that each fragment rises or falls throughout. Places nearer than eps() to each other count as one.
class SideArrangement {
 public:
  struct Fragment {
    Index from, to;  // of place
    Index side;
  };
  struct Place {
    Point at;             // relative to the network's origin
    Index original = none;  // the vertex of the network there
    bool pole = false;    // nothing but a highest or lowest place
  };

  /// Nothing if cancelled.
  static std::optional<SideArrangement> make(const CurveNetwork& network, std::span<const RingSide> sides,
                                             const Context& context);

  const std::vector<Place>& places() const { return place_; }
  const std::vector<Fragment>& fragments() const { return fragment_; }  ///< side by side, in the order they run
  std::span<const RingSide> sides() const { return sides_; }
  /// Fragments that coincide, whichever way they run, one after the other: groups[i] .. groups[i+1) of order.
  const std::vector<Index>& order() const { return order_; }
  const std::vector<Index>& groups() const { return groups_; }
  double eps() const { return eps_; }

  Vector<quad> at(Index place) const { return {place_[place].at.x, place_[place].at.y}; }
  /// True if the fragment rises; if it is level: runs to greater x. What RayToTheLeft tells is on its left then.
  bool runs_up(Index fragment) const;
  /// The place of the fragment half-way between its ends.
  Vector<quad> middle(Index fragment) const;
  /// Where the fragment is at height y, between those of its ends.
  quad x_at(Index fragment, quad y) const;
  /// The direction, as an angle, in which the fragment's place at a small distance from one of its ends is seen from it.
  double direction(Index fragment, bool from_start, double distance) const;

 private:
  SideArrangement(const CurveNetwork& network, std::span<const RingSide> sides);
  SideCourse course(Index side) const;
  Index place_at(Vector<quad> p, Index original, bool pole);
  void cut_pair(Index i, Index j);
  void cut_at_poles();
  void make_fragments();
  void group();
  double height(const Fragment& f) const;

  std::vector<RingSide> sides_;
  double eps_;
  std::vector<Place> place_;
  std::vector<Index> from_, to_;  // per side
  struct Cut {
    double along;
    Index place;
  };
  std::vector<std::vector<Cut>> cuts_;  // per side
  std::unordered_map<std::uint64_t, std::vector<Index>> cells_;  // places by the cell of a grid they are in
  std::vector<Fragment> fragment_;
  std::vector<Index> order_, groups_;
};

/// Which features' fragments a ray to the left meets.
class RayToTheLeft {
 public:
  explicit RayToTheLeft(const SideArrangement& arrangement);
  /// The features that hold, by the even-odd rule, what is just left of the fragments of a group (just above if they
  /// are level); sorted.
  std::vector<std::int64_t> holding(Index group) const;
  /// The features of which an odd number of the group's fragments are sides; sorted.
  std::vector<std::int64_t> changing(Index group) const;

 private:
  static std::vector<kernel::Box> boxes_of(const SideArrangement& arrangement);
  const SideArrangement& a_;
  std::vector<Index> group_of_;
  kernel::BoxTree tree_;
};

}  // namespace krepl::arcs
