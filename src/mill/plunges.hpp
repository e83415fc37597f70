#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "mill/cover_proof.hpp"
#include "mill/plan.hpp"

namespace krepl::mill {

/// Cuts straight down, to single places of the surface that no pass gets to: the ends of gaps between walls that all but touch. There a
/// path must not keep more away from the walls than it needs to: two units more of distance can be a hundred along the gap.
class Plunges {
 public:
  /// `cutter`: of plan.radius. `open`: with the contact ball, two units larger at least, and the smallest cubes that are wanted.
  Plunges(const DropCutter& cutter, const DropCutter& contact, const CoverOptions& cover, const Plan& plan, double unit)
      : cutter_(cutter), contact_(contact), cover_(cover), plan_(plan), unit_(unit) {}

  /// Proves tiles again, in finer cubes, and makes cuts of a single place where that fails, until it does not any more. `add_cuts` adds to a
  /// proof what there is. `open` becomes the places that remain. False if cancelled.
  bool serve(const std::function<void(CoverProof&)>& add_cuts, std::vector<std::size_t> tiles,
             const std::function<bool(Point3, double)>& is_of_interest, const Context& context,
             std::vector<Cut>& plunges, std::vector<Point3>& open) const;

  struct Found {
    std::optional<Point3> at;  ///< of the lattice, absolute, where the cutter rests
    bool is_empty;             ///< the contact ball is free nowhere so near to the place
  };
  /// The nearest place of the lattice to a place, within `within` of it in x and y, at which the cutter rests no more than that higher.
  Found find(Point3 place, double within) const;

 private:
  bool add(const std::vector<Point3>& found, std::vector<Cut>& plunges) const;

  const DropCutter &cutter_, &contact_;
  CoverOptions cover_;
  const Plan& plan_;
  double unit_;
};

}  // namespace krepl::mill
