#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/terrain.hpp"
#include "krepl/tool_path.hpp"

namespace krepl {

/// Which place of the tool the numbers of a post's Z mean.
enum class ControlPoint { tip, centre };

/// A ball-nose cutter and what is common to all strategies. Lengths are in the unit of the part's coordinates.
struct MillTool {
  double radius = 0;     ///< of the ball: finite and positive
  double allowance = 0;  ///< stock left everywhere, measured normal to the surface: 0 or more
};

/// How exactly a path follows its surface, and where its numbers come to lie.
///
/// The path never cuts into the part (grown by the allowance): it stays above the sum of the part and the ball, and
/// comes nowhere farther above it than the tolerance, measured normal to it. Between the places where heights are
/// computed that is proven by bounds, not sampled. Ends of moves and centres of arcs are multiples of `unit`, as a post
/// will write them, so that nothing is rounded afterwards; this takes 5.5 units and an eighth of the tolerance, up to a
/// quarter more for passes that are not along x or y.
struct MillAccuracy {
  double tolerance = 0.01;  ///< at least 16 units
  double unit = 1e-4;       ///< last decimal of the numbers; at least 2^-34 S, S the largest of extent and radius
  ControlPoint control_point = ControlPoint::tip;  ///< of which Z is a multiple of the unit
  bool arcs = true;                                ///< arcs in planes along x or y
  /// How far inside of its arcs a controller's chords may be; arcs stay so far above the surface (GRBL: 0.002 mm).
  double arc_error = 0;
};

/// Where and how fast the tool moves between cuts.
struct MillMotion {
  double feed = 1000, plunge_feed = 300;  ///< units a minute
  double rapid_feed = 5000;               ///< for the estimate of time only
  /// Height of the control point at the start, at the end and for moves over everything. Nothing given: the part's top,
  /// or the lowest the tool gets to over it, and a radius more.
  std::optional<double> safe_height;
  double clearance = -1;  ///< of rapid links above what is below them; negative: half a radius
};

struct ParallelOptions {
  MillTool tool;
  MillAccuracy accuracy;
  MillMotion motion;
  /// Distance of neighbouring passes in the plane, or, if 0, from `scallop`.
  double step_over = 0;
  /// Greatest height of what is left between passes, tolerance included. Where the surface is steep across the passes
  /// or hollow, gaps are halved, up to four times, until it holds in cross-sections half a pass distance apart; what
  /// then remains (next to walls and in sharp valleys along the passes) is counted in the report.
  double scallop = 0;
  double angle =
      0;  ///< of the passes, degrees counter-clockwise from +x; turned a little (report) to meet places of few decimals
  bool zigzag = true;  ///< else all passes run one way
  /// The tip never goes below it. Nothing given: the part's lowest place; then passes are cut only where the ball
  /// touches the part.
  std::optional<double> bottom;
};

/// What a tool path consists of.
struct MillReport {
  std::size_t passes = 0, cuts = 0, lines = 0, arcs = 0, rapids = 0;
  double cutting_length = 0, rapid_length = 0;
  double minutes = 0;               ///< without accelerations
  std::size_t curve_points = 0;     ///< of the polylines above the drive curves that moves were fitted to
  std::uint64_t touches = 0;        ///< evaluations of a triangle's sum with the ball
  double step_over = 0;             ///< used
  std::size_t extra_passes = 0;     ///< parts of passes between others, for the sake of the scallop
  std::size_t sections = 0;         ///< across the passes, looked at for that
  std::size_t uneven_sections = 0;  ///< of them, where the scallop is exceeded
  double angle = 0;                 ///< used, degrees
};

struct MilledPath {
  ToolPath path;  ///< the control point is the ball's centre; coordinates are absolute
  MillReport report;
};

/// Parallel finishing passes with a ball: over the part's plan and a radius beyond, each pass in a vertical plane
/// (docs/mill.md).
///
/// Passes along x or y consist of lines and arcs (planes ZX, YZ), others of lines. Between cuts the tool goes straight
/// up, level, and straight down again, above everything on the way. The same path for any number of threads.
///
/// Errors: an option out of its range (usage); unit or radius too fine for the coordinates; a safe height below the
/// part; no place that the ball touches; cancelled. Expected time proportional to the number of moves' pieces.
Result<MilledPath> mill_parallel(std::shared_ptr<const Terrain> part, const ParallelOptions& options,
                                 const Context& context = {});

}  // namespace krepl
