#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

namespace krepl::verify {

/// Axis-parallel box in space; empty when new.
struct Box3 {
  double low[3] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                   std::numeric_limits<double>::infinity()};
  double high[3] = {-low[0], -low[1], -low[2]};
  void add(double x, double y, double z) {
    const double p[3] = {x, y, z};
    for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  }
  void add(const Box3& b) {
    for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], b.low[k]), high[k] = std::max(high[k], b.high[k]);
  }
  void grow(double by) {
    for (int k = 0; k < 3; ++k) low[k] -= by, high[k] += by;
  }
  /// Square of the horizontal distance from (x, y); zero above or below the box.
  double square_distance(double x, double y) const {
    const double dx = std::max({low[0] - x, x - high[0], 0.0}), dy = std::max({low[1] - y, y - high[1], 0.0});
    return dx * dx + dy * dy;
  }
};

/// A binary tree over boxes, halved at the median of their middles in the plane. As with NearestTree, its only possible
/// fault is to lose items.
class BoxHierarchy {
 public:
  BoxHierarchy() = default;
  explicit BoxHierarchy(const std::vector<Box3>& boxes) : order_(boxes.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    nodes_.reserve(boxes.size() / 2 + 2);
    if (!boxes.empty()) build(boxes, 0, std::uint32_t(boxes.size()));
  }

  bool empty() const { return nodes_.empty(); }
  const Box3& box() const { return nodes_[0].box; }

  /// Visits items in boxes with key(box) <= limit(), a bound that may fall meanwhile; of two boxes the one with the
  /// smaller key first. An infinite key leaves a box out.
  template <class Key, class Limit, class Visit>
  void search(Key&& key, Limit&& limit, Visit&& visit) const {
    if (nodes_.empty()) return;
    const double first = key(nodes_[0].box);
    if (first < std::numeric_limits<double>::infinity()) descend(0, first, key, limit, visit);
  }

  /// Visits items whose own box may meet `box` in the plane.
  template <class Visit>
  void for_each_near(const Box3& box, Visit&& visit) const {
    search(
        [&](const Box3& b) {
          const bool meets =
              b.low[0] <= box.high[0] && box.low[0] <= b.high[0] && b.low[1] <= box.high[1] && box.low[1] <= b.high[1];
          return meets ? 0.0 : std::numeric_limits<double>::infinity();
        },
        [] { return 0.0; }, visit);
  }

 private:
  struct Node {
    Box3 box;
    std::uint32_t first, last;  // leaf: a range of order_
    std::uint32_t right = 0;    // inner: the second child (the first follows); 0 marks a leaf
  };
  static constexpr std::uint32_t leaf_size = 4;

  void build(const std::vector<Box3>& boxes, std::uint32_t first, std::uint32_t last) {
    const std::size_t self = nodes_.size();
    nodes_.push_back({{}, first, last});
    const auto middle = [&](std::uint32_t i, int k) { return boxes[i].low[k] / 2 + boxes[i].high[k] / 2; };
    Box3 all, middles;
    for (std::uint32_t i = first; i < last; ++i) {
      all.add(boxes[order_[i]]);
      middles.add(middle(order_[i], 0), middle(order_[i], 1), 0);
    }
    nodes_[self].box = all;
    if (last - first <= leaf_size) return;
    const int k = middles.high[0] - middles.low[0] >= middles.high[1] - middles.low[1] ? 0 : 1;
    const std::uint32_t half = first + (last - first) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + half, order_.begin() + last,
                     [&](std::uint32_t a, std::uint32_t b) { return middle(a, k) < middle(b, k); });
    build(boxes, first, half);
    nodes_[self].right = std::uint32_t(nodes_.size());
    build(boxes, half, last);
  }

  template <class Key, class Limit, class Visit>
  void descend(std::uint32_t n, double own, Key& key, Limit& limit, Visit& visit) const {
    if (own > limit()) return;
    const Node& node = nodes_[n];
    if (node.right == 0) {
      for (std::uint32_t i = node.first; i < node.last; ++i) visit(order_[i]);
      return;
    }
    std::uint32_t near = n + 1, far = node.right;
    double near_key = key(nodes_[near].box), far_key = key(nodes_[far].box);
    if (far_key < near_key) std::swap(near, far), std::swap(near_key, far_key);
    if (near_key < std::numeric_limits<double>::infinity()) descend(near, near_key, key, limit, visit);
    if (far_key < std::numeric_limits<double>::infinity()) descend(far, far_key, key, limit, visit);
  }

  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace krepl::verify
