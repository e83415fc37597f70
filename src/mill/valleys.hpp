#pragma once

#include <vector>

#include "krepl/context.hpp"
#include "krepl/drop_cutter.hpp"
#include "krepl/surface.hpp"

namespace krepl::mill {

struct ValleyOptions {
  double flatten = 0;   ///< about how far polylines may be from the curves
  double angle = 0;     ///< least angle between the normals of both sides, radians
  double shortest = 0;  ///< of chains
};

/// Polylines along valleys, relative to the part's origin.
struct Valleys {
  std::vector<std::vector<Point3>> chains;
  std::size_t edges = 0;      ///< that chains are made of
  std::size_t too_short = 0;  ///< chains left out
};

/// Valleys of a surface, and the feet of its walls: below a rim the ball rests on the lower side at a height that
/// `foot`, of a slightly smaller ball, tells, as that does not touch the wall. False if cancelled.
bool find_valleys(const Surface& surface, const DropCutter& foot, const ValleyOptions& options, const Context& context,
                  Valleys& valleys);

}  // namespace krepl::mill
