#pragma once

#include "terrain/drop_cutter_search.hpp"

namespace krepl::drop {

/// How high a tool rests on one triangle, and how that changes with its place: no tool on this triangle is anywhere
/// higher than `height` and `slope` times the way to there. `slope` is one of several where heights have a kink.
struct PartTouch {
  double height = nothing;  ///< of the tip; `nothing` if no place of the triangle is within R
  Point slope{};
};

/// A triangle alone, touched by a tool that is no ball. Constant time; to 1e-12 S, as the drop cutter.
PartTouch touch_part(const Part& part, const ProfileTool& tool);

}  // namespace krepl::drop
