#pragma once

#include <cstdint>
#include <vector>

#include "krepl/point.hpp"
#include "view/surface/shape.hpp"

namespace krepl::view {

/// Samples of a shape seen from above, on the corners of square cells, at several levels: level 0 has the whole square
/// in `cells` times `cells` cells, each further level twice as many a side. What is drawn from afar.
class HeightPyramid {
 public:
  /// Cells of a tile a side, the same at every level.
  static constexpr int cells = 32;

  /// Samples the triangles at the finest level; coarser ones have every second sample, and the mean share of the kinds
  /// about it. Time: that of the triangles' boxes in samples, and 4^levels * cells^2.
  HeightPyramid(const Shape& shape, Point low, double side, int levels);

  struct Sample {
    float height;                   ///< NaN: nothing there
    std::uint8_t cylinder, sphere;  ///< share of the kinds of patches nearby, of 255; the rest is planes
  };
  int levels() const { return int(levels_.size()); }
  /// Column and row from the square's least corner; beyond the square there is nothing.
  Sample sample(int level, std::int64_t column, std::int64_t row) const;

 private:
  struct Level {
    std::int64_t side;  // samples
    std::vector<Sample> samples;
  };
  void draw(const Shape& shape, Point low, double cell);
  static Level coarser(const Level& fine);

  std::vector<Level> levels_;  // coarsest first
};

}  // namespace krepl::view
