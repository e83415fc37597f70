#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "kernel/box_tree.hpp"
#include "kernel/hilbert.hpp"
#include "model/noding.hpp"

namespace krepl::model {

/// Segments in an order that follows the plane, and a tree over their boxes, which it names by their place in that
/// order.
class SegmentTree {
 public:
  SegmentTree(std::span<const GridPoint> vertices, std::span<const GridSegment> segments)
      : order_(sorted(vertices, segments)), tree_(boxes(vertices, segments)) {}

  std::uint32_t segment(std::size_t place) const { return order_[place]; }
  const kernel::BoxTree& tree() const { return tree_; }

  static Point point(GridPoint p) { return {double(p.x), double(p.y)}; }
  static kernel::Box box(std::span<const GridPoint> vertices, GridSegment s) {
    kernel::Box box;
    box.add(point(vertices[s.a]));
    box.add(point(vertices[s.b]));
    return box;
  }

 private:
  static std::vector<std::uint32_t> sorted(std::span<const GridPoint> vertices, std::span<const GridSegment> segments) {
    kernel::Box all;
    for (const GridSegment& s : segments) all.add(box(vertices, s));
    const double scale = 65535 / std::max({1.0, all.max_x - all.min_x, all.max_y - all.min_y});
    std::vector<std::pair<std::uint32_t, std::uint32_t>> keyed(segments.size());
    for (std::uint32_t i = 0; i < segments.size(); ++i) {
      const kernel::Box b = box(vertices, segments[i]);
      keyed[i] = {kernel::HilbertCurve::index(std::uint32_t(((b.min_x + b.max_x) / 2 - all.min_x) * scale),
                                              std::uint32_t(((b.min_y + b.max_y) / 2 - all.min_y) * scale)),
                  i};
    }
    std::sort(keyed.begin(), keyed.end());
    std::vector<std::uint32_t> order(segments.size());
    std::transform(keyed.begin(), keyed.end(), order.begin(), [](const auto& entry) { return entry.second; });
    return order;
  }
  std::vector<kernel::Box> boxes(std::span<const GridPoint> vertices, std::span<const GridSegment> segments) const {
    std::vector<kernel::Box> result(segments.size());
    for (std::size_t i = 0; i < segments.size(); ++i) result[i] = box(vertices, segments[order_[i]]);
    return result;
  }

  std::vector<std::uint32_t> order_;
  kernel::BoxTree tree_;
};

}  // namespace krepl::model
