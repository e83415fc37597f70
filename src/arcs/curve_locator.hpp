#pragma once

#include <vector>

#include "kernel/box_tree.hpp"
#include "krepl/curve_network.hpp"

namespace krepl::arcs {

/// Whether places lie in the polygons of lines with arcs, by the even-odd rule per feature.
class CurveLocator {
 public:
  explicit CurveLocator(const CurveNetwork& network);

  /// True if p (relative to the origin) is in a polygon. Places on a border, or hardly off it, may be told either way.
  bool is_inside(Point p) const;

 private:
  static constexpr std::size_t chunk = 16;  // consecutive sides under one box
  struct Side {
    Point p, q;
    std::int64_t feature;
    bool arc = false, left = false;  // an arc turns left or right
    bool wide = false;               // more than half a turn
    Point to_centre;                 // from p
  };
  static std::vector<Side> sides_of(const CurveNetwork& network);
  static std::vector<kernel::Box> boxes_of(const std::vector<Side>& sides);
  static bool is_crossed(const Side& side, Point from);

  std::vector<Side> sides_;
  kernel::BoxTree tree_;
};

}  // namespace krepl::arcs
