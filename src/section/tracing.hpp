#pragma once

#include <functional>
#include <span>
#include <vector>

#include "section/crossings.hpp"

namespace krepl::section {

/// How a cut runs from crossing to crossing: which of them it enters faces by, and by which it leaves these. High, or
/// left of the line, is left of it.
class Tracing {
 public:
  explicit Tracing(const Parts& parts) : parts_(parts) {}

  std::vector<Crossing> crossings;  ///< by edge, ascending, and along it

  /// Pairs what enters each face with what leaves it, by their order along the cut: `place` tells it. Faces without a
  /// patch are left out. False if numbers differ, which does not happen where neighbours agree. On a curve that is
  /// closed, a circle by its angle, `holds` tells what it is inside a face between crossings.
  using PlaceOf = std::function<Patch::Place(const Patch&, const Crossing&)>;
  using HoldsAt = std::function<bool(Index face, const Patch&, double angle)>;
  [[nodiscard]] bool pair(const PlaceOf& place, const HoldsAt& holds);

  /// The face that the cut enters at a crossing, and the one it comes from; none if it does neither.
  Index entered(Index crossing) const { return face(crossing, !crossings[crossing].rising); }
  Index left(Index crossing) const { return face(crossing, crossings[crossing].rising); }
  bool enters(Index crossing) const { return exit_[crossing] != none; }
  /// Where it leaves the face that it enters there.
  Index exit(Index crossing) const { return exit_[crossing]; }
  /// On a circle: the angle from a crossing to that, as little below zero as rounding has it or up to a whole turn.
  double sweep(Index crossing) const { return sweep_[crossing]; }
  /// Of the faces with crossings.
  bool meets(Index face) const;

 private:
  struct Visit {
    Index face, crossing;
    bool enters;
    Patch::Place place;
  };
  Index face(Index crossing, bool left_of_edge) const;
  using Visits = std::span<Visit>;
  bool match(Visits visits, const Patch& patch, const HoldsAt& holds);
  bool match_run(Visits run, bool starts_inside);

  const Parts& parts_;
  std::vector<Visit> visits_;
  std::vector<Index> exit_;
  std::vector<double> sweep_;
};

}  // namespace krepl::section
