#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/cutter.hpp"
#include "krepl/error.hpp"
#include "krepl/terrain.hpp"
#include "krepl/tool_path.hpp"

namespace krepl {

/// Which place of the tool the numbers of a post's Z mean.
enum class ControlPoint { tip, centre };

/// The cutter and what is common to all strategies. Lengths are in the unit of the part's coordinates.
struct MillTool {
  double radius = 0;     ///< of a ball-nose cutter: finite and positive
  double allowance = 0;  ///< stock left everywhere, measured normal to the surface: 0 or more
  /// Another cutter than a ball, in place of `radius`, for parallel passes, waterlines and roughing; other strategies refuse it. The rims of
  /// cones and tapers leave up to 1 / cos(angle / 4) times the allowance.
  std::optional<Cutter> cutter;
};

/// How exactly a path follows its surface, and where its numbers come to lie.
///
/// The path never cuts into the part (grown by the allowance): it stays above the sum of the part and the cutter (upside down), and
/// comes nowhere farther above it than the tolerance, measured normal to it. Between the places where heights are
/// computed that is proven by bounds, not sampled. Ends of moves and centres of arcs are multiples of `unit`, as a post
/// will write them, so that nothing is rounded afterwards; this takes 5.5 units (6.5 for
/// cutters that are no balls) and an eighth of the tolerance, up to a quarter more for passes that are not along x or y.
struct MillAccuracy {
  double tolerance = 0.01;  ///< at least 16 units
  double unit = 1e-4;       ///< last decimal of the numbers; at least 2^-34 S, S the largest of extent and radius
  ControlPoint control_point = ControlPoint::tip;  ///< of which Z is a multiple of the unit; of other cutters than balls the tip
  bool arcs = true;                                ///< arcs in planes along x or y, of waterlines in level ones
  /// How far inside of its arcs a controller's chords may be; arcs stay so far above the surface (GRBL: 0.002 mm).
  double arc_error = 0;
  /// Smaller arcs are cut as lines. LinuxCNC refuses radii below 0.00127 mm or 0.00005 in.
  double least_arc_radius = 0;
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

/// Polygons of the plane, in the part's coordinates; each consists of rings, an outline and holes. Rings are closed, their first point is
/// not repeated at the end.
struct MillBoundary {
  std::vector<std::vector<std::vector<Point>>> polygons;
};

struct ParallelOptions {
  MillTool tool;
  MillAccuracy accuracy;
  MillMotion motion;
  /// Distance of neighbouring passes in the plane, or, if 0, from `scallop`.
  double step_over = 0;
  /// For balls: greatest height of what is left above all that the ball can reach (the part's closing by it, within the limits). It is
  /// proven, as by ScallopOptions; where that fails, as on slopes across the passes, in hollows and along walls, passes are added
  /// between others, then the tool goes straight down to single places. What then remains is counted in the report. Along a wall the tool's
  /// shank counts. What a ball four units larger does not enter is no gap.
  double scallop = 0;
  double angle =
      0;  ///< of the passes, degrees counter-clockwise from +x; turned a little (report) to meet places of few decimals
  bool zigzag = true;  ///< else all passes run one way
  /// The tip never goes below it. Nothing given: the part's lowest place; then passes are cut only where the ball
  /// touches the part.
  std::optional<double> bottom;
  /// Only where the surface of the control point is less steep than that, degrees, and a step-over
  /// beyond, along and across; waterlines with the same angle as `steep` cut the rest. 0: everywhere.
  double shallow = 0;
  /// The axis stays within any of these polygons: passes end at the last lattice point before it, ways between cuts that would leave it
  /// are taken at the safe height. None: everywhere.
  MillBoundary boundary;
};

/// What a tool path consists of.
struct MillReport {
  std::size_t passes = 0, cuts = 0, lines = 0, arcs = 0, rapids = 0;
  double cutting_length = 0, rapid_length = 0;
  double minutes = 0;               ///< without accelerations
  std::size_t curve_points = 0;     ///< of the polylines above the drive curves that moves were fitted to
  std::uint64_t touches = 0;        ///< evaluations of a triangle's sum with the ball
  std::size_t levels = 0;           ///< of roughing and waterlines
  std::size_t skipped_cuts = 0;     ///< of roughing: rings, or stretches of passes, too short to be entered; of waterlines: rings as
                                    ///< small as a unit; of pencil passes: short valleys
  std::size_t lifted_moves = 0;     ///< moves not proven free: of waterlines, pencil, scallop and rest passes taken over what is in
                                    ///< their way, of roughing left out
  double step_over = 0;             ///< used
  std::size_t extra_passes = 0;     ///< parts of passes between others, and single places, for the sake of the scallop
  double angle = 0;                 ///< used, degrees
  std::size_t open_places = 0;      ///< with a scallop: places where more is left, and cubes an eighth of it large in which it is not
                                    ///< proven to be kept
};

struct MilledPath {
  ToolPath path;  ///< the control point is a ball's centre, another cutter's tip; coordinates are absolute
  MillReport report;
};

/// Parallel finishing passes with a ball or another cutter: over the part's plan and a radius beyond, each pass in a vertical plane
/// (docs/mill.md).
///
/// Passes along x or y consist of lines and arcs (planes ZX, YZ), others of lines. Between cuts the tool goes straight
/// up, level, and straight down again, above everything on the way. The same path for any number of threads.
///
/// Errors: an option out of its range (usage); unit or radius too fine for the coordinates; a safe height below the
/// part; no place that the ball touches; cancelled. Expected time proportional to the number of moves' pieces.
Result<MilledPath> mill_parallel(std::shared_ptr<const Terrain> part, const ParallelOptions& options,
                                 const Context& context = {});

/// How levels are cleared in roughing.
enum class RoughPattern {
  offsets,  ///< in rings parallel to the part, from outside of the stock inwards
  zigzag    ///< in parallel passes
};

struct RoughOptions {
  MillTool tool;  ///< with the stock that finishing is to take off as its allowance
  RoughPattern pattern = RoughPattern::offsets;
  MillAccuracy accuracy;
  MillMotion motion;
  double step_over = 0;   ///< distance of neighbouring passes
  double step_down = 0;   ///< greatest distance of levels
  double angle = 0;       ///< of the passes of zigzag, as ParallelOptions has it
  double ramp_angle = 3;  ///< steepest way down into the stock, degrees, above 0 and below 90
  /// The stock is a block: the part's bounding rectangle and `stock_margin` on all sides, up to `stock_top` (nothing
  /// given: the part's top).
  double stock_margin = 0;
  std::optional<double> stock_top;
  /// Of the lowest level, of the tip. Nothing given: the part's lowest place and the allowance.
  std::optional<double> bottom;
};

/// Roughing by levels: takes a part out of a block of stock. On every level, from the top, the places where the tool
/// does not touch the part (grown by the allowance) are cleared.
///
/// In offsets: rings at equal distances (the step-over, or the tool's radius if that is less) from where the tool may not be, the
/// farthest first, each of which takes off a strip of that width; where nothing is in the way, along the sides of the stock. Rings are
/// lines and arcs, entered from outside of the stock, from rings cut before, else down a helix (G3 with Z) where there is room for one
/// of a quarter of the tool's radius, else down a ramp along the ring. Rings follow distances on a raster of an eighth of the step-over; each move
/// is proven free like those of mill_waterline, and one that is not is left out and counted. Stock is kept on the raster, so
/// that nothing is cut in the air.
///
/// In zigzag: parallel passes; neighbouring passes make up regions that are cut without lifting the tool, entered from outside of the
/// stock if one of their passes gets there, else by a ramp along the first pass. Moves are proven free by the same bounds as those of mill_parallel.
///
/// Regions with no pass or ring longer than the tool's radius are left to finishing and counted. Above the levels the tool moves at the safe
/// height, which is above the stock. All on lattice points of levels that are lattice heights.
///
/// Errors: as mill_parallel; a step down or ramp angle out of its range; a step-over that means more than 8 million places
/// of the raster (offsets).
Result<MilledPath> mill_rough(std::shared_ptr<const Terrain> part, const RoughOptions& options,
                              const Context& context = {});

struct WaterlineOptions {
  MillTool tool;
  MillAccuracy accuracy;
  MillMotion motion;
  double step_down = 0;  ///< greatest distance of levels
  bool climb = true;     ///< the part is on the right of the way, else on its left
  double steep = 0;      ///< only where the surface is at least so steep, degrees from level, below 90; 0: everywhere
  /// Lowest height of the tip. Nothing given: the part's lowest place, on which the ball rests then.
  std::optional<double> bottom;
  MillBoundary boundary;  ///< as ParallelOptions has it; contours end there to within the tolerance
};

/// Waterlines: on evenly spaced levels, from the part's top down, the tool goes around the part (grown by the allowance)
/// along the exact contours of the surface of its centre, rings from outside to inside, as lines and arcs in level planes.
///
/// The contours are those of a ball larger by about half the tolerance, and the path is fitted within the other half of it on both
/// sides: distances from the part change by no more than what a path is away from a curve. Each move is then proven free by
/// bounds on the height of the surface below it, which know nothing of contours; one that is not is taken over what is in its
/// way and counted. Level ground at the height of a level counts as free: the ball may rest on it. Links are those of
/// mill_parallel. The same path for any number of threads.
///
/// For other cutters than balls the contours are traced on level sets of the tip's height, in cells of a quarter of the radius: rings and
/// gaps narrower than that may be missed.
///
/// Errors: as mill_parallel and compute_surface; a step down or steep angle out of its range; nothing to cut on any level.
/// Time: that of the surface and of the contours, and some 20 us a move.
Result<MilledPath> mill_waterline(std::shared_ptr<const Terrain> part, const WaterlineOptions& options,
                                  const Context& context = {});

struct PencilOptions {
  MillTool tool;
  MillAccuracy accuracy;
  MillMotion motion;
  double valley_angle = 20;  ///< only valleys where the two sides' normals differ by as much, degrees, 0 to below 180
  double shortest = -1;      ///< chains of valleys shorter than that are left out; negative: the tool's radius
};

/// Pencil passes: along the valleys of the surface of the ball's centre (of the part grown by the allowance), where the ball touches
/// the part in two places, and along the feet of vertical walls, where the surface jumps.
///
/// They are edges of the exact surface's subdivision, joined at its vertices to chains, where several meet the straightest two. Lines in
/// space are fitted to them, and each is proven free, as those of mill_waterline. Each chain is run from the end nearer to where the tool is,
/// the nearest chain first (of more than 4,000, in the order of the subdivision). The same path for any number of threads.
///
/// Errors: as mill_parallel and compute_surface; an angle out of its range; no such valley.
Result<MilledPath> mill_pencil(std::shared_ptr<const Terrain> part, const PencilOptions& options,
                               const Context& context = {});

struct ScallopOptions {
  MillTool tool;
  MillAccuracy accuracy;
  MillMotion motion;
  double scallop = 0;        ///< greatest height of what is left anywhere; two tolerances to half the tool's radius
  double valley_angle = 20;  ///< passes start from valleys with an angle between the normals of their sides of at least that, degrees
};

/// Passes at a constant scallop: along the valleys of the surface of the ball's centre, and along lines at constant distances from
/// them and from the border, measured on the surface so that slopes and walls have as many passes as they need, hollows more and
/// edges fewer. Vertical walls are cut where the ball rests on something at their foot.
///
/// What is left above what the ball can reach (the part's closing by the ball) is proven not to be higher than the scallop: by bounds
/// on what the tool leaves of each cube of space that its centre may rest in (docs/mill.md). Where that fails, lines are added half-way
/// between others, up to six times; cubes that remain are counted in the report. Moves are lines, and proven free as those of
/// mill_pencil. The same path for any number of threads.
///
/// Errors: as mill_pencil; a scallop out of its range, or so low that its raster has more than 16 million places.
/// Time: that of the surface, and some 20 us for each place of a raster of an eighth of the step-over, most of it for the proof. Rest passes take longer where
/// the larger ball cannot reach: a millisecond a place.
Result<MilledPath> mill_scallop(std::shared_ptr<const Terrain> part, const ScallopOptions& options,
                                const Context& context = {});

struct RestOptions {
  MillTool tool;
  MillAccuracy accuracy;
  MillMotion motion;
  double scallop = 0;        ///< as ScallopOptions has it
  double valley_angle = 20;  ///< likewise
  double after = 0;          ///< radius of the larger ball that has been there before, with the same allowance
  double threshold = -1;     ///< what it may have left, normal to the surface, tolerance to tool radius; negative: the scallop
};

/// Rest machining: the passes of mill_scallop only where a larger ball cannot take off all that is more than a threshold above what
/// this one reaches, however close its passes are: where the part's closing by the larger ball is so much higher.
///
/// Errors: as mill_scallop; a larger tool that is not; a threshold out of its range; nothing left.
Result<MilledPath> mill_rest(std::shared_ptr<const Terrain> part, const RestOptions& options, const Context& context = {});

}  // namespace krepl
