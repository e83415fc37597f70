#pragma once

#include "krepl/cutter.hpp"
#include "simulate/path_pieces.hpp"
#include "terrain/drop_cutter_profile.hpp"

namespace krepl::simulate {

/// A cutter, balls included, that moves in straight lines.
class SweptTool {
 public:
  explicit SweptTool(const Cutter& cutter);

  double radius() const { return tool_.radius; }

  /// The lowest point of the tool over a place, anywhere on its way: infinity if it does not come over it.
  ///
  /// It is the least of z(t) + f(|place - p(t)|). Upside down that is a drop cutter over the place, let down on the way
  /// with its heights negated: the same closed forms.
  double lowest(const Piece& piece, Point place) const;

  /// How deep a point is inside the tool at the most on its way; negative or zero if it never is. The depth is concave
  /// along a straight way, as the tool is convex.
  double depth(const Piece& piece, Point3 point) const;

 private:
  double depth_at(Point3 tip, Point3 point) const;
  drop::ProfileTool tool_;
};

}  // namespace krepl::simulate
