#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mill/drive_curve.hpp"

namespace krepl::mill {

/// A place of the lattice of numbers that a post writes, in a vertical plane: t = i step, z = z0 + k unit.
struct LatticePoint {
  std::int64_t i, k;
  friend bool operator==(const LatticePoint&, const LatticePoint&) = default;
};

/// A move along a pass to the end, from where the one before ends. Arcs turn by less than half a circle.
struct FittedMove {
  enum class Kind : std::uint8_t { line, over, under } kind;  ///< over: an arc about a centre below; under: above
  LatticePoint end, centre;
};

struct FitOptions {
  double step = 0;         ///< of t
  double unit = 0;         ///< of z, and of the centres of arcs
  double z0 = 0;           ///< a height of the lattice
  double band = 0;         ///< how far above the curve the moves may be, measured normal to them; many units
  double arc_lift = 0;     ///< how far arcs over a top stay above the curve, for controllers that cut chords instead
  double most_radius = 0;  ///< of arcs; 0: no arcs
  double least_radius = 0;
};

/// Lines and arcs between points of a lattice that are nowhere below a run of a drive curve (except for arcs, of which
/// centres on the lattice take a unit) and nowhere farther above it than the band. Greedy: each move goes as far as it
/// can.
class CurveFit {
 public:
  CurveFit(std::span<const CurvePoint> curve, const FitOptions& options) : curve_(curve), options_(options) {}

  /// Precondition: the run starts and ends at multiples of the step. Returns where the path starts; appends the moves.
  LatticePoint run(std::vector<FittedMove>& moves);

 private:
  double t(std::int64_t i) const { return double(i) * options_.step; }
  double z(std::int64_t k) const { return options_.z0 + double(k) * options_.unit; }
  std::int64_t above(double z) const;
  /// Last multiple of the step at or before t.
  std::int64_t before(double t) const;
  /// The curve's highest point over [low, high]; `hint`: a vertex at or before low.
  double highest(double low, double high, std::size_t hint) const;

  std::optional<FittedMove> line_from(LatticePoint p, std::size_t open, std::size_t next) const;
  std::optional<FittedMove> arc_from(LatticePoint p, std::size_t next, std::int64_t at_least) const;
  std::optional<FittedMove> arc_to(LatticePoint p, std::size_t next, std::size_t last) const;
  bool arc_holds(LatticePoint p, const FittedMove& arc, std::size_t next, std::size_t last) const;
  void step_aside(LatticePoint& p, std::size_t next, std::vector<FittedMove>& moves) const;

  std::span<const CurvePoint> curve_;
  FitOptions options_;
};

}  // namespace krepl::mill
