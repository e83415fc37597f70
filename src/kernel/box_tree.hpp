#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "krepl/point.hpp"

namespace krepl::kernel {

struct Box {
  double min_x = std::numeric_limits<double>::infinity(), min_y = min_x;
  double max_x = -min_x, max_y = -min_x;
  void add(Point p) {
    min_x = std::min(min_x, p.x), max_x = std::max(max_x, p.x);
    min_y = std::min(min_y, p.y), max_y = std::max(max_y, p.y);
  }
  void add(const Box& b) {
    min_x = std::min(min_x, b.min_x), max_x = std::max(max_x, b.max_x);
    min_y = std::min(min_y, b.min_y), max_y = std::max(max_y, b.max_y);
  }
  /// True if they share a point, be it of their borders.
  bool meets(const Box& b) const { return min_x <= b.max_x && b.min_x <= max_x && min_y <= b.max_y && b.min_y <= max_y; }
};

/// A packed tree, eight children a node, over boxes in the order given (which should follow the plane: along curves).
/// Answers questions about horizontal rays and about boxes.
class BoxTree {
 public:
  explicit BoxTree(std::vector<Box> boxes) {
    levels_.push_back(std::move(boxes));
    while (levels_.back().size() > 1) {
      const auto& below = levels_.back();
      std::vector<Box> level((below.size() + arity - 1) / arity);
      for (std::size_t i = 0; i < below.size(); ++i) level[i / arity].add(below[i]);
      levels_.push_back(std::move(level));
    }
  }

  /// Visits boxes that the ray from p towards smaller x meets and that reach beyond limit(), a bound that may grow while
  /// hits are found; boxes further right first among siblings.
  template <class Limit, class Visit>
  void visit_left_of(Point p, Limit&& limit, Visit&& visit) const {
    if (!levels_[0].empty()) descend(levels_.size() - 1, 0, p, limit, visit);
  }

  /// Visits the boxes that share a point with this one, in their order.
  template <class Visit>
  void visit_meeting(const Box& box, Visit&& visit) const {
    if (!levels_[0].empty()) descend_meeting(levels_.size() - 1, 0, box, visit);
  }

 private:
  static constexpr std::size_t arity = 8;

  template <class Visit>
  void descend_meeting(std::size_t level, std::size_t index, const Box& box, Visit& visit) const {
    if (!levels_[level][index].meets(box)) return;
    if (level == 0) return visit(index);
    const std::size_t first = index * arity, last = std::min(first + arity, levels_[level - 1].size());
    for (std::size_t i = first; i < last; ++i) descend_meeting(level - 1, i, box, visit);
  }

  template <class Limit, class Visit>
  void descend(std::size_t level, std::size_t index, Point p, Limit& limit, Visit& visit) const {
    const Box& b = levels_[level][index];
    if (b.min_y > p.y || b.max_y < p.y || b.min_x > p.x || b.max_x < limit()) return;
    if (level == 0) return visit(index);
    const std::size_t first = index * arity, last = std::min(first + arity, levels_[level - 1].size());
    const auto& below = levels_[level - 1];
    std::size_t order[arity];  // by falling max_x; few enough to insert one by one
    for (std::size_t i = first; i < last; ++i) {
      std::size_t j = i - first;
      for (; j > 0 && below[order[j - 1]].max_x < below[i].max_x; --j) order[j] = order[j - 1];
      order[j] = i;
    }
    for (std::size_t i = 0; i < last - first; ++i) descend(level - 1, order[i], p, limit, visit);
  }

  std::vector<std::vector<Box>> levels_;
};

}  // namespace krepl::kernel
