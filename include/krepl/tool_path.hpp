#pragma once

#include <vector>

#include "krepl/point.hpp"

namespace krepl {

/// What a machine does in one move. Arcs are clockwise or counter-clockwise as seen against the axis that is orthogonal to
/// their plane (from +Z, +Y, +X for the planes XY, ZX, YZ), as G2 and G3 are; a coordinate along that axis may change evenly
/// with the angle (a helix).
enum class MoveKind { rapid, line, clockwise, counter_clockwise };
enum class ArcPlane { xy, zx, yz };  ///< G17, G18, G19

struct Move {
  MoveKind kind = MoveKind::line;
  ArcPlane plane = ArcPlane::xy;  ///< of arcs
  Point3 end;                     ///< of the tool's control point
  Point3 centre;                  ///< of arcs; its coordinate along the axis has no meaning
  double feed = 0;                ///< units a minute; rapid moves have none
};

/// Moves of one tool, one after the other, from a place that is free. Coordinates are those of the part; the control point is
/// the ball's centre for ball-nose cutters and the tip for all others: posts translate (`--control-point`).
struct ToolPath {
  Point3 start;
  std::vector<Move> moves;
};

}  // namespace krepl
