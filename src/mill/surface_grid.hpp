#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/drop_cutter.hpp"

namespace krepl::mill {

/// The surface of a ball's centre over a raster of places, and distances along it, measured as scallops need it: where the
/// surface is hollow, places are farther apart than they are in space.
///
/// Balls of radius r at two places of the surface at distance d, with unit normals n and m, leave a ridge as on a plane at distance
/// sqrt(d^2 + (r - h) d.(n - m)), up to terms of higher order in h / r; n - m is what the surface is bent by.
class SurfaceGrid {
 public:
  using Index = std::uint32_t;
  static constexpr Index none = ~Index{0};

  struct Options {
    double step = 0;    ///< of the raster
    double radius = 0;  ///< of the tool
    double height = 0;  ///< of scallops
  };

  /// Over the part's bounding rectangle and the ball's radius beyond. False if cancelled.
  bool build(const DropCutter& cutter, const Options& options, const Context& context);
  /// How many places a raster of that step has.
  static double count(const DropCutter& cutter, double step);

  std::size_t columns() const { return columns_; }
  std::size_t rows() const { return rows_; }
  std::size_t size() const { return columns_ * rows_; }
  double step() const { return o_.step; }
  Point place(Index v) const {
    return {first_.x + double(v % columns_) * o_.step, first_.y + double(v / columns_) * o_.step};
  }
  bool touches(Index v) const { return height_[v] > lowest; }
  Point3 centre(Index v) const {
    const Point p = place(v);
    return {p.x, p.y, height_[v]};
  }
  Point3 normal(Index v) const;
  /// Four places around one of the plane: the one of least x and y; none outside of the raster.
  Index cell_of(double x, double y) const;

  /// Between two places where the ball touches something.
  double metric(Index v, Index w) const;
  /// From any point of the surface, that has no normal.
  double distance_to(Index v, Point3 p) const;

  /// Least distances from places that have a finite one in `distance` (infinite elsewhere), along chords between places that
  /// are a knight's move apart or nearer: at most 2.8 % too long on a plane.
  void spread(std::vector<double>& distance) const;

 private:
  static constexpr double lowest = -1e300;
  Options o_;
  Point first_;
  std::size_t columns_ = 0, rows_ = 0;
  std::vector<double> height_;
  std::vector<float> normal_;  // three for each place
};

}  // namespace krepl::mill
