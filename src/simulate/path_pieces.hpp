#pragma once

#include <cstdint>
#include <vector>

#include "krepl/error.hpp"
#include "krepl/tool_path.hpp"

namespace krepl::simulate {

/// A straight way of the tool's tip.
struct Piece {
  Point3 from, to;
  std::uint32_t move;
  bool rapid;
};

/// An arc or helix of a path: its points by the angle passed.
class Arc {
 public:
  /// Precondition: the move is one. If start and end differ in their distance from the centre, it changes evenly.
  Arc(Point3 from, const Move& move);
  double angle() const { return angle_; }  ///< passed in all, positive; 2 pi if start and end have the same direction
  double radius() const { return radius_ > end_radius_ ? radius_ : end_radius_; }
  double length() const;
  /// fraction in [0,1]
  Point3 at(double fraction) const;
  /// So many chords of equal angle keep within `error` of it: the arc's point and the chord's at the same fraction are
  /// r angle^2 / 8 apart at most, if the radius is r throughout.
  std::size_t chords(double error) const;

 private:
  ArcPlane plane_;
  double centre_u_, centre_v_, radius_, end_radius_, start_angle_, angle_, sense_;
  double from_w_, to_w_;  // along the axis
};

/// The path's moves as pieces; `lift` is taken off z (from the control point to the tip), `origin` from all
/// coordinates.
std::vector<Piece> pieces_of(const ToolPath& path, Point3 origin, double lift, double arc_error);

double length_of(Point3 from, const Move& move);

}  // namespace krepl::simulate
