#pragma once

#include <vector>

#include "krepl/drop_cutter.hpp"
#include "mill/grid_lines.hpp"

namespace krepl::mill {

/// Brings lines onto the surface of a ball's centre: where all is at distance R from the part, walls included.
///
/// How far a place is from the part is found by dropping balls of other radii on it: one that rests there has that distance as
/// its radius, and touches what is nearest.
class OnSurface {
 public:
  /// `flatten`: how far lines may be from the surface in their middle; `shortest`: pieces that are not halved any more.
  OnSurface(const DropCutter& cutter, double flatten, double shortest)
      : cutter_(cutter), flatten_(flatten), shortest_(shortest) {}

  /// The nearest point of the surface if p is free, else one near p.
  Point3 put(Point3 p) const;
  /// Puts points onto the surface, and points between them where chords are farther from it. Points nearer than half of
  /// `shortest` to the one before are left out. Several lines where no points between are on the way, as past a rim.
  std::vector<SpaceLine> put(const SpaceLine& line) const;

 private:
  struct Nearest {
    double distance;
    Point3 place;
    bool found;
  };
  Nearest nearest(Point3 p) const;
  void append(Point3 a, Point3 b, int depth, std::vector<SpaceLine>& lines) const;

  const DropCutter& cutter_;
  double flatten_, shortest_;
};

}  // namespace krepl::mill
