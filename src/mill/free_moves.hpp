#pragma once

#include <optional>

#include "mill/drive_curve.hpp"
#include "mill/lifted_cutter.hpp"
#include "mill/links.hpp"
#include "mill/plan.hpp"

namespace krepl::mill {

/// The larger cutter that makes room for arcs as chords, and how much its control point is below that of the tool.
Result<DropCutter> make_prover(const DropCutter& cutter, const Plan& plan, const Band& band, const MillTool& tool);
double prover_lift(const Plan& plan, const Band& band, const MillTool& tool);

/// Proves moves free by bounds of the surface's height below them, however they came about. One for each thread.
class FreeMoves {
 public:
  /// `cutter`: of band.proof_radius, or larger than the tool by band.proof_room.
  FreeMoves(const LiftedCutter& cutter, const Band& band, const Plan& plan, double unit)
      : cutter_(cutter), band_(band), plan_(plan), unit_(unit) {}

  /// At `lift_feed` takes moves that are not proven free, lines and arcs in level planes, over what is in their way: up, level, down.
  /// Returns how many.
  std::size_t settle(Cut& cut, double lift_feed);

  /// Of a line or an arc, a helix included.
  bool is_free(Point3 from, const Move& move);

 private:
  bool is_free_line(Point3 from, Point3 to);
  double highest(Point3 from, Point3 to, double slope, double floor, double accuracy);
  double round_up(double z) const;
  Point3 raised(Point3 p) const;
  double top_over(Point3 from, const Move& move);

  LiftedCutter cutter_;
  std::unique_ptr<LineBodies> bodies_;
  const Band& band_;
  const Plan& plan_;
  double unit_, floor_ = 0, accuracy_ = 0;
  std::optional<DriveCurve> curve_;
};

/// Points of an arc or a helix from `from`, the radius changing evenly, so that it is within `sagitta` of the chords between
/// them.
void append_chords(Point3 from, const Move& arc, double sagitta, std::vector<Point3>& points);

}  // namespace krepl::mill
