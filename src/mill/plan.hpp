#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "krepl/cutter.hpp"
#include "krepl/mill.hpp"

namespace krepl::mill {

/// Lengths that follow from the options, all relative to the part's origin.
struct Plan {
  double radius;    // of the cutter as it is computed with: allowance and room for the lattice's arcs
  Cutter cutter = *Cutter::ball(1);  // as it is computed with
  double lift;      // from its control point to that of the tool: 0 for balls
  double accuracy;  // of drive curves
  double slack;     // of make_bodies(); 0 for balls
  double band;      // for fitting
  double tip;       // from the control point's height to that of the centre (other cutters have the one only)
  double z0;        // a height of the lattice, of the centre
  double floor;     // of the centre
  double safe;      // absolute, of the centre
  double step_over;
};

/// How the tolerance is shared out for paths that are fitted to curves of the surface of a somewhat larger ball.
///
/// Whatever moves by a length comes nearer to the part, or farther from it, by that length at most. So a path within e of a curve
/// on the surface of a ball of radius r keeps between r - e and r + e from the part.
struct Band {
  double curve_radius;    // of the ball on whose surface the curves lie
  double within;          // of the path from the curve
  double proof_radius;    // of the ball for which moves are proven free: arcs by chords, a controller's or ours
  // For other cutters: how much larger they are in place of these balls, allowance not included.
  double curve_room, proof_room;
  double proof_accuracy;  // how far above the true height bounds may be
  double sagitta;         // of chords for the proof
};
/// `farther`: what a cutter's growth is multiplied with at its rim (roundness()).
Band make_band(const Plan& plan, const MillAccuracy& accuracy, double farther = 1);

/// Errors of code usage and cancelled.
Error usage(const std::string& what, const std::string& remedy);
Error cancelled();
bool is_positive(double x);

/// What a strategy can do paths of.
enum class Cutters { balls, all };

/// Checks the options, all but step_down and the like of other strategies.
Result<Plan> make_plan(const Terrain& part, const ParallelOptions& options, Cutters cutters = Cutters::balls);

/// Checks what strategies without parallel passes share.
Result<Plan> make_plan(const Terrain& part, const MillTool& tool, const MillAccuracy& accuracy, const MillMotion& motion,
                       std::optional<double> bottom, Cutters cutters = Cutters::balls);

/// The largest radius of the tool.
double radius_of(const MillTool& tool);

/// Heights of levels in units, evenly spaced, no farther apart than `step_down`, both ends included. bottom < top.
Result<std::vector<std::int64_t>> spread_levels(std::int64_t top, std::int64_t bottom, double unit, double step_down);

/// Adds counts and lengths of a path.
void measure(const ToolPath& path, const MillMotion& motion, MillReport& report);

}  // namespace krepl::mill
