#pragma once

#include <vector>

#include "krepl/context.hpp"
#include "mill/level_lines.hpp"
#include "mill/lifted_cutter.hpp"

namespace krepl::mill {

struct LevelSetOptions {
  double within = 0;  ///< of the polylines from the level set, on both sides
  double grain = 0;   ///< shorter gaps count as none; far less than `within`
  double cell = 0;    ///< rings and gaps narrower than cells of that side may be missed
  double steep = 0;   ///< as LevelLineOptions has it
  bool reversed = false;
};

/// The border of the places over which a cutter that is no ball rests higher than a level (of its control point,
/// relative to the part's origin), as closed polylines, the higher side on the left unless reversed; outer rings before
/// what is inside of them.
///
/// Cells of a quadtree are divided until the border enters and leaves each but once, on sides that are cut exactly;
/// there it is a chord, divided until a line on one side of it, so far off as is asked for, is free and one on the
/// other side is not. So every place of the polyline is as near to both. False if rounding made sides of neighbouring
/// cells differ, for each of several lattices.
bool trace_level_set(const LiftedCutter& cutter, double level, const LevelSetOptions& options, const Context& context,
                     std::vector<LevelRing>& rings);

}  // namespace krepl::mill
