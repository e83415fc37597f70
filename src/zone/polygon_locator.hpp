#pragma once

#include <cstdint>
#include <vector>

#include "kernel/box_tree.hpp"
#include "krepl/network.hpp"

namespace krepl::zone {

/// Which of a network's polygons a point lies in, by the even-odd rule per feature.
class PolygonLocator {
 public:
  explicit PolygonLocator(const Network& network);

  /// The features whose polygons contain p (relative to the network's origin), ascending. Points on a ring may be told
  /// either way.
  void find(Point p, std::vector<std::int64_t>& features) const;

 private:
  static constexpr std::size_t chunk = 16;  // consecutive sides under one box
  struct Side {
    Point p, q;
    std::int64_t feature;
  };
  static std::vector<Side> sides_of(const Network& network);
  static std::vector<kernel::Box> boxes_of(const std::vector<Side>& sides);

  std::vector<Side> sides_;
  kernel::BoxTree tree_;
};

}  // namespace krepl::zone
