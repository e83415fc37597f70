#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "verify/plane.hpp"

namespace krepl::verify {

/// A binary tree over items, halved at the median of their boxes' middles. Only to make the brute force affordable: a
/// fault in it can only lose items, which makes distances too large and shows up as a violation, never hides one.
/// Item has box() and distance(Vec).
template <class Item>
class NearestTree {
 public:
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  struct Hit {
    Real distance = HUGE_VALL;
    std::uint32_t item = none;
  };

  explicit NearestTree(std::vector<Item> items) : items_(std::move(items)) {
    std::vector<std::uint32_t> order(items_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::vector<Box> boxes;
    boxes.reserve(items_.size());
    for (const Item& item : items_) boxes.push_back(item.box());
    if (!order.empty()) build(order, boxes, 0, std::uint32_t(order.size()));
    order_ = std::move(order);
  }

  const std::vector<Item>& items() const { return items_; }
  Box box() const { return nodes_.empty() ? Box{} : nodes_[0].box; }

  /// The item nearest to p among those nearer than `limit`.
  Hit nearest(Vec p, Real limit = HUGE_VALL) const {
    Hit best;
    best.distance = limit;
    if (!nodes_.empty()) search(0, p, best);
    return best;
  }

  /// Calls f(index) for each item whose box meets b.
  template <class F>
  void for_each_in(const Box& b, F&& f) const {
    if (!nodes_.empty()) visit(0, b, f);
  }

 private:
  struct Node {
    Box box;
    std::uint32_t first, last;  // leaf: a range of order_
    std::uint32_t right = 0;    // inner: the second child (the first follows); 0 marks a leaf
  };
  static constexpr std::uint32_t leaf_size = 6;

  void build(std::vector<std::uint32_t>& order, const std::vector<Box>& boxes, std::uint32_t first,
             std::uint32_t last) {
    const std::size_t self = nodes_.size();
    nodes_.push_back({{}, first, last});
    Box all, middles;
    for (std::uint32_t i = first; i < last; ++i) all.add(boxes[order[i]]), middles.add(boxes[order[i]].middle());
    nodes_[self].box = all;
    if (last - first <= leaf_size) return;
    const bool by_x = middles.x1 - middles.x0 >= middles.y1 - middles.y0;
    const std::uint32_t half = first + (last - first) / 2;
    std::nth_element(order.begin() + first, order.begin() + half, order.begin() + last,
                     [&](std::uint32_t a, std::uint32_t b) {
                       const Vec p = boxes[a].middle(), q = boxes[b].middle();
                       return by_x ? p.x < q.x : p.y < q.y;
                     });
    build(order, boxes, first, half);
    nodes_[self].right = std::uint32_t(nodes_.size());
    build(order, boxes, half, last);
  }

  void search(std::uint32_t n, Vec p, Hit& best) const {
    const Node& node = nodes_[n];
    if (node.right == 0) {
      for (std::uint32_t i = node.first; i < node.last; ++i) {
        const Real d = items_[order_[i]].distance(p);
        if (d < best.distance) best = {d, order_[i]};
      }
      return;
    }
    const Real left = nodes_[n + 1].box.square_distance(p), right = nodes_[node.right].box.square_distance(p);
    const bool swap = right < left;
    const std::uint32_t child[2] = {swap ? node.right : n + 1, swap ? n + 1 : node.right};
    const Real square[2] = {std::min(left, right), std::max(left, right)};
    for (int k = 0; k < 2; ++k)
      // The margin keeps rounding in the square from dropping a box that holds an equally near item.
      if (square[k] * (1 - 1e-15L) <= best.distance * best.distance) search(child[k], p, best);
  }

  template <class F>
  void visit(std::uint32_t n, const Box& b, F& f) const {
    const Node& node = nodes_[n];
    if (!node.box.meets(b)) return;
    if (node.right != 0) return visit(n + 1, b, f), visit(node.right, b, f);
    for (std::uint32_t i = node.first; i < node.last; ++i)
      if (items_[order_[i]].box().meets(b)) f(order_[i]);
  }

  std::vector<Item> items_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace krepl::verify
