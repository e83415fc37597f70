#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace krepl::kernel {

/// A packed tree, eight children a node, over boxes in the order given (which should follow the plane), whose nodes can
/// be visited one by one: level 0 are the boxes themselves, the last level has one node. A Box begins empty and has
/// add(const Box&).
template <class Box>
class PackedTree {
 public:
  static constexpr std::size_t arity = 8;

  explicit PackedTree(std::vector<Box> boxes) {
    levels_.push_back(std::move(boxes));
    while (levels_.back().size() > 1) {
      const auto& below = levels_.back();
      std::vector<Box> level((below.size() + arity - 1) / arity);
      for (std::size_t i = 0; i < below.size(); ++i) level[i / arity].add(below[i]);
      levels_.push_back(std::move(level));
    }
  }

  bool empty() const { return levels_[0].empty(); }
  std::size_t top() const { return levels_.size() - 1; }
  const Box& box(std::size_t level, std::size_t index) const { return levels_[level][index]; }
  /// Children of a node above level 0: [first, last) one level below.
  std::pair<std::size_t, std::size_t> children(std::size_t level, std::size_t index) const {
    return {index * arity, std::min(index * arity + arity, levels_[level - 1].size())};
  }

  /// Visits boxes with bound(box) < limit, those with less first among siblings. `limit` may be lowered by
  /// visit(index).
  template <class Bound, class Visit>
  void nearest(double& limit, const Bound& bound, const Visit& visit) const {
    if (!empty() && bound(box(top(), 0)) < limit) descend(top(), 0, limit, bound, visit);
  }

 private:
  template <class Bound, class Visit>
  void descend(std::size_t level, std::size_t index, double& limit, const Bound& bound, const Visit& visit) const {
    if (level == 0) return visit(index);
    const auto [first, last] = children(level, index);
    std::pair<double, std::size_t> order[arity];
    std::size_t count = 0;
    for (std::size_t i = first; i < last; ++i) {
      const double b = bound(box(level - 1, i));
      if (!(b < limit)) continue;
      std::size_t j = count++;  // few enough to insert one by one
      for (; j > 0 && order[j - 1].first > b; --j) order[j] = order[j - 1];
      order[j] = {b, i};
    }
    for (std::size_t i = 0; i < count && order[i].first < limit; ++i)
      descend(level - 1, order[i].second, limit, bound, visit);
  }

  std::vector<std::vector<Box>> levels_;
};

}  // namespace krepl::kernel
