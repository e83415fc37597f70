#pragma once

#include <string>

#include "krepl/mill.hpp"

namespace krepl::mill {

/// Lengths that follow from the options, all relative to the part's origin.
struct Plan {
  double radius;    // of the cutter as it is computed with: allowance and room for the lattice's arcs
  double accuracy;  // of drive curves
  double band;      // for fitting
  double tip;       // from the control point's height to that of the centre
  double z0;        // a height of the lattice, of the centre
  double floor;     // of the centre
  double safe;      // absolute, of the centre
  double step_over;
};

/// An Error of code usage.
Error usage(const std::string& what, const std::string& remedy);
bool is_positive(double x);

/// Checks the options, all but step_down and the like of other strategies.
Result<Plan> make_plan(const Terrain& part, const ParallelOptions& options);

/// Adds counts and lengths of a path.
void measure(const ToolPath& path, const MillMotion& motion, MillReport& report);

}  // namespace krepl::mill
