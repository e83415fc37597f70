#pragma once

#include <memory>
#include <vector>

#include "incremental/parts.hpp"

namespace krepl::incremental {

/// A curve of centres of balls that touch `own`, with a parameter. What of it is on the sum's boundary is another
/// matter.
struct Curve {
  enum class Shape : std::uint8_t {
    line,     ///< base + t first
    circle,   ///< about base, t in [-1, 3]
    section,  ///< of edge's cylinder by the plane first . c = size, t in [-1, 1] around the cylinder
    pair      ///< of edge's cylinder and another part's, one of two branches; t in [0, 1]
  };
  enum class Role : std::uint8_t {
    side,    ///< where own[0]'s patch ends and own[1]'s continues it smoothly
    rim,     ///< where own[0]'s patch ends in a wall
    meeting  ///< the patches of own[0] and own[1] cross
  };

  Shape shape;
  Role role;
  std::array<Index, 2> own{none, none};  ///< parts
  Real begin = 0, end = 0;
  Vector base, first, second;
  Real size = 0;
  // section, pair: the cylinder
  Vector at, direction, aside, up;
  Real radius = 0;
  // pair: the other one, which is a sphere if `axis` is null; between these turns; a fold is where the branches meet
  Vector other, axis;
  Real from_turn = 0, to_turn = 0, sign = 1;
  bool fold[2] = {false, false};
  std::array<Real, 5> discriminant{};  // a polynomial in the turn without its zeros at the folds

  Vector point(Real t) const;
};

using CurvePointer = std::shared_ptr<const Curve>;

/// Sides and rims of a part's patch, ends included.
std::vector<Curve> outline(const Parts& parts, Index part);

/// Where the patches of two parts cross. Empty for neighbours that continue each other smoothly, and for parts whose
/// surfaces coincide or touch without crossing. Lines are cut where a patch of `second` ends.
std::vector<Curve> meetings(const Parts& parts, Index first, Index second);

}  // namespace krepl::incremental
