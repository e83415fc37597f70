#include "mill/plan.hpp"

#include <algorithm>
#include <cmath>

#include "mill/boundary.hpp"
#include "mill/grown_cutter.hpp"
#include "model/radius_check.hpp"

namespace krepl::mill {

Error usage(const std::string& what, const std::string& remedy) { return {ErrorCode::usage, what, "", remedy}; }
Error cancelled() { return {ErrorCode::cancelled, "cancelled", "", ""}; }

bool is_positive(double x) { return std::isfinite(x) && x > 0; }

namespace {

constexpr double gentle = 0.9;  // the cosine of 26 degrees

bool is_ball(const MillTool& tool) { return !tool.cutter || tool.cutter->kind() == Cutter::Kind::ball; }

Status check(const ParallelOptions& o, Cutters cutters) {
  if (cutters == Cutters::balls && !is_ball(o.tool))
    return usage("the strategy makes no paths of tool '" + o.tool.cutter->text() + "', only of ball-nose cutters",
                 "use parallel passes or waterlines, or a ball");
  if (o.scallop != 0 && !is_ball(o.tool))
    return usage("heights of scallops are known of ball-nose cutters only, not of tool '" + o.tool.cutter->text() + "'",
                 "give the step-over");
  if (o.accuracy.control_point == ControlPoint::centre && !is_ball(o.tool))
    return usage("tool '" + o.tool.cutter->text() + "' has no centre", "use its tip as the control point");
  if (!is_positive(radius_of(o.tool)))
    return usage("the tool's radius is not a finite number greater than zero", "give one in the unit of the part");
  if (!std::isfinite(o.tool.allowance) || o.tool.allowance < 0)
    return usage("the allowance is not a finite number of zero or more", "");
  if (!is_positive(o.accuracy.unit))
    return usage("the unit of coordinates is not a finite number greater than zero", "");
  if (!is_positive(o.accuracy.tolerance)) return usage("the tolerance is not a finite number greater than zero", "");
  if (o.accuracy.tolerance < 16 * o.accuracy.unit + 2 * o.accuracy.arc_error)
    return usage("the tolerance " + shown(o.accuracy.tolerance) + " is too small for numbers that are multiples of " +
                     shown(o.accuracy.unit),
                 "use at least " + shown(16 * o.accuracy.unit + 2 * o.accuracy.arc_error) + ", or more decimals");
  if (!is_positive(o.motion.feed) || !is_positive(o.motion.plunge_feed) || !is_positive(o.motion.rapid_feed))
    return usage("a feed is not a finite number greater than zero", "give units a minute");
  if (!(o.shallow >= 0 && o.shallow < 90)) return usage("the shallow angle is not between 0 and 90 degrees", "");
  if (Status checked = check_boundary(o.boundary); !checked) return checked.error();
  if (!std::isfinite(o.angle)) return usage("the angle is not a finite number", "give degrees");
  if ((o.step_over != 0) == (o.scallop != 0))
    return usage("there is not one of step-over and scallop height", "give one of them");
  if (o.step_over != 0 && !is_positive(o.step_over))
    return usage("the step-over is not a finite number greater than zero", "");
  if (o.scallop != 0 && !(is_positive(o.scallop) && o.scallop <= radius_of(o.tool) / 2))
    return usage("the scallop height is not between 0 and half the tool's radius", "");
  if (o.scallop != 0 && o.scallop <= 1.25 * o.accuracy.tolerance)
    return usage(
        "the scallop height " + shown(o.scallop) + " leaves no room for the tolerance " + shown(o.accuracy.tolerance),
        "use a tolerance of at most " + shown(o.scallop / 1.25));
  return std::monostate{};
}

/// Two balls of radius R at distance w leave a ridge of R - sqrt(R^2 - w^2 / 4) on a plane along the passes. Somewhat
/// less, so that gentle slopes across them need no further passes.
double step_over_of(const ParallelOptions& o) {
  if (o.step_over != 0) return o.step_over;
  const double height = o.scallop - o.accuracy.tolerance, radius = radius_of(o.tool) + o.tool.allowance;
  return gentle * 2 * std::sqrt(2 * radius * height - height * height);
}

}  // namespace

double radius_of(const MillTool& tool) { return tool.cutter ? tool.cutter->radius() : tool.radius; }

Result<Plan> make_plan(const Terrain& part, const ParallelOptions& o, Cutters cutters) {
  if (Status checked = check(o, cutters); !checked) return checked.error();
  const MillAccuracy& a = o.accuracy;
  Plan plan;
  const double radius = radius_of(o.tool);
  plan.radius = radius + o.tool.allowance + 2 * a.unit;
  const Result<Cutter> cutter =
      is_ball(o.tool) ? Cutter::ball(2 * plan.radius) : grow(*o.tool.cutter, o.tool.allowance, 2 * a.unit);
  if (!cutter) return cutter.error();
  plan.cutter = *cutter;
  plan.lift = is_ball(o.tool) ? 0 : o.tool.allowance + 2 * a.unit;
  if (a.unit < 0x1p-34 * std::max({part.extent(), plan.radius, std::abs(part.origin().x), std::abs(part.origin().y)}))
    return usage("numbers that are multiples of " + shown(a.unit) + " are too fine for the part's coordinates",
                 "use fewer decimals");
  plan.slack = is_ball(o.tool) ? 0 : a.tolerance / 32;
  plan.accuracy = a.tolerance / 8 - plan.slack;
  plan.band = a.tolerance - a.tolerance / 8 - 4.5 * a.unit - a.arc_error;
  if (!is_ball(o.tool)) plan.band -= a.unit;  // sharp rims are farther out: roundness()
  const Point3 origin = part.origin(), low = part.lowest(), high = part.highest();
  // From the control point to the lowest point, of the tool and of the one that is computed with.
  const double above_tip = is_ball(o.tool) ? radius : 0, above_grown = is_ball(o.tool) ? plan.radius : plan.lift;
  plan.tip = a.control_point == ControlPoint::tip ? above_tip : 0;
  plan.z0 = plan.tip - origin.z;
  plan.floor = o.bottom ? *o.bottom + above_tip - origin.z : low.z + above_grown;
  const double top = std::max(high.z + above_grown, plan.floor) + origin.z;
  const double height = o.motion.safe_height ? *o.motion.safe_height + plan.tip : top + radius;
  plan.safe = std::ceil((height - plan.tip) / a.unit) * a.unit + plan.tip;
  if (plan.safe < top)
    return usage(
        "the safe height " + shown(*o.motion.safe_height) + " is below the highest place of the tool over the part",
        "use at least " + shown(top - plan.tip));
  plan.step_over = step_over_of(o);
  if (plan.step_over < 4 * a.unit)
    return usage("the step-over " + shown(plan.step_over) + " is too fine for the numbers' decimals", "");
  if (plan.step_over < 1e-6 * part.extent())
    return usage("the step-over " + shown(plan.step_over) + " means more than a million passes", "use a larger one");
  return plan;
}

Result<Plan> make_plan(const Terrain& part, const MillTool& tool, const MillAccuracy& accuracy, const MillMotion& motion,
                       std::optional<double> bottom, Cutters cutters) {
  ParallelOptions o;
  o.tool = tool, o.accuracy = accuracy, o.motion = motion, o.bottom = bottom;
  o.step_over = part.extent() + 8 * accuracy.unit;  // there are no passes
  return make_plan(part, o, cutters);
}

Band make_band(const Plan& plan, const MillAccuracy& a, double farther) {
  const double room = a.tolerance - 2 * a.unit - 2 * a.arc_error;  // at least 14 units
  Band band;
  band.sagitta = room / 16, band.proof_accuracy = room / 8;
  band.proof_room = 2 * a.unit + a.arc_error + band.sagitta;
  const double before = band.proof_room + band.proof_accuracy;
  if (farther == 1)
    band.within = (room - band.sagitta - band.proof_accuracy) / 2;
  else
    band.within = (a.tolerance - a.arc_error - farther * before) / (1 + farther);
  band.curve_room = before + band.within;
  band.proof_radius = plan.radius + a.arc_error + band.sagitta;
  band.curve_radius = band.proof_radius + band.proof_accuracy + band.within;
  return band;
}

Result<std::vector<std::int64_t>> spread_levels(std::int64_t top, std::int64_t bottom, double unit, double step_down) {
  const double count = std::max(1.0, std::ceil(double(top - bottom) * unit / step_down - 1e-9));
  if (count > 100000) return usage("the step down means more than 100,000 levels", "use a larger one");
  std::vector<std::int64_t> heights;
  for (double n = 0; n <= count; ++n)
    heights.push_back(top - std::int64_t(std::llround(double(top - bottom) * n / count)));
  return heights;
}

void measure(const ToolPath& path, const MillMotion& motion, MillReport& report) {
  Point3 at = path.start;
  for (const Move& m : path.moves) {
    const bool arc = m.kind == MoveKind::clockwise || m.kind == MoveKind::counter_clockwise;
    double length = std::hypot(m.end.x - at.x, m.end.y - at.y, m.end.z - at.z);
    if (arc) {
      const double radius = m.plane == ArcPlane::zx   ? std::hypot(at.x - m.centre.x, at.z - m.centre.z)
                            : m.plane == ArcPlane::yz ? std::hypot(at.y - m.centre.y, at.z - m.centre.z)
                                                      : std::hypot(at.x - m.centre.x, at.y - m.centre.y);
      length = 2 * radius * std::asin(std::min(1.0, length / (2 * radius)));
    }
    if (m.kind == MoveKind::rapid)
      ++report.rapids, report.rapid_length += length, report.minutes += length / motion.rapid_feed;
    else
      ++(arc ? report.arcs : report.lines), report.cutting_length += length, report.minutes += length / m.feed;
    at = m.end;
  }
}

}  // namespace krepl::mill
