#pragma once

#include <functional>
#include <vector>

#include "section/crossings.hpp"

namespace krepl::section {

/// How a cut runs from crossing to crossing: which of them it enters faces by, and by which it leaves these. High, or left of the
/// line, is left of it.
class Tracing {
 public:
  explicit Tracing(const Parts& parts) : parts_(parts) {}

  std::vector<Crossing> crossings;  ///< by edge, ascending, and along it

  /// Pairs what enters each face with what leaves it, by their order along the cut: `place` tells it. Faces without a patch are
  /// left out. False if numbers differ, which does not happen where neighbours agree.
  using PlaceOf = std::function<Patch::Place(const Patch&, const Crossing&)>;
  [[nodiscard]] bool pair(const PlaceOf& place);

  /// The face that the cut enters at a crossing, and the one it comes from; none if it does neither.
  Index entered(Index crossing) const { return face(crossing, !crossings[crossing].rising); }
  Index left(Index crossing) const { return face(crossing, crossings[crossing].rising); }
  bool enters(Index crossing) const { return exit_[crossing] != none; }
  /// Where it leaves the face that it enters there.
  Index exit(Index crossing) const { return exit_[crossing]; }
  /// Of the faces with crossings.
  bool meets(Index face) const;

 private:
  struct Visit {
    Index face, crossing;
    bool enters;
    Patch::Place place;
  };
  Index face(Index crossing, bool left_of_edge) const;
  bool match(std::vector<Visit>::iterator first, std::vector<Visit>::iterator last);

  const Parts& parts_;
  std::vector<Visit> visits_;
  std::vector<Index> exit_;
};

}  // namespace krepl::section
