#pragma once

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <vector>

#include "voronoi/sites.hpp"

namespace krepl::voronoi {

/// A packed tree of bounding boxes, eight children a node, over the sites in their (Hilbert) order, in single precision
/// rounded outwards. A search visits what lies nearest to a place first and leaves out what the caller says cannot
/// matter.
class SiteBoxes {
 public:
  struct Box {
    Vector<double> centre, half;
  };
  /// A box that nodes are compared with.
  struct SearchWindow : Box {
    SearchWindow() : SearchWindow(Box{}) {}
    explicit SearchWindow(const Box& box);
    float low_x, high_x, low_y, high_y;  // rounded outwards
  };

  SiteBoxes(const Instance& instance, const Context& context);

  /// What a search reuses of the one before: a few boxes of the tree that hold all sites of an area, so that it need
  /// not start at the root; and memory.
  class Memory {
   private:
    friend class SiteBoxes;
    struct Waiting {
      std::uint64_t entry;
      std::uint32_t changes;  // of the reach before it was found to meet it
      friend bool operator>(const Waiting& a, const Waiting& b) { return a.entry > b.entry; }
    };
    Box area_{{0, 0}, {-1, -1}};
    std::uint32_t level_ = 0;
    std::vector<std::uint32_t> start_, below_;
    std::vector<std::uint64_t> stack_;
    std::vector<Waiting> heap_;
  };

  /// Calls visit(site) for every site whose box, and the boxes above it, meet window() and pass meets(box). Both may
  /// become narrower meanwhile; visit() tells whether they did. Nearest to `from` first: where little is known yet.
  template <class Window, class Meets, class Visit>
  void search_nearest(Vector<double> from, Memory& memory, Window&& window, Meets&& meets, Visit&& visit) const;
  /// The same by going down the tree, nearest boxes first: where what is found will not make the window much narrower.
  template <class Window, class Meets, class Visit>
  void search_near(Vector<double> from, Memory& memory, Window&& window, Meets&& meets, Visit&& visit) const;

 private:
  static constexpr int arity = 8;
  static constexpr unsigned index_bits = 28;
  struct Node {
    /// Which boxes meet a window, as bits.
    unsigned meeting(const SearchWindow& window) const;
    float min_x[arity], min_y[arity], max_x[arity], max_y[arity];
  };
  static std::uint64_t entry(float distance, std::uint32_t level, std::uint32_t index) {
    return std::uint64_t{std::bit_cast<std::uint32_t>(distance)} << 32 | level << index_bits | index;
  }
  static bool meeting(const Box& a, const Box& b) {
    return std::abs(a.centre.x - b.centre.x) <= a.half.x + b.half.x &&
           std::abs(a.centre.y - b.centre.y) <= a.half.y + b.half.y;
  }
  static bool within(const Box& a, const Box& b) {
    return std::abs(a.centre.x - b.centre.x) + a.half.x <= b.half.x &&
           std::abs(a.centre.y - b.centre.y) + a.half.y <= b.half.y;
  }
  static float squared_distance(Vector<double> from, const Box& b) {
    const double dx = std::max(std::abs(b.centre.x - from.x) - b.half.x, 0.0);
    const double dy = std::max(std::abs(b.centre.y - from.y) - b.half.y, 0.0);
    return float(dx * dx + dy * dy);
  }
  /// Makes memory.start_ hold all sites of the window.
  void find_start(const Box& window, Memory& memory) const;
  Box box(std::uint32_t level, std::uint32_t index) const {
    const Node& n = levels_[level][index / arity];
    const unsigned k = index % arity;
    const double low_x = n.min_x[k], low_y = n.min_y[k], high_x = n.max_x[k], high_y = n.max_y[k];
    return {{(low_x + high_x) / 2, (low_y + high_y) / 2}, {(high_x - low_x) / 2, (high_y - low_y) / 2}};
  }

  std::vector<std::vector<Node>> levels_;  // levels_[0]: boxes of sites; the last level is one node
};

inline unsigned SiteBoxes::Node::meeting(const SearchWindow& window) const {
  const float low_x = window.low_x, high_x = window.high_x, low_y = window.low_y, high_y = window.high_y;
  unsigned bits = 0;
#ifdef __SSE2__
  for (int k = 0; k < arity; k += 4) {
    __m128 meets = _mm_cmple_ps(_mm_loadu_ps(min_x + k), _mm_set1_ps(high_x));
    meets = _mm_and_ps(meets, _mm_cmpge_ps(_mm_loadu_ps(max_x + k), _mm_set1_ps(low_x)));
    meets = _mm_and_ps(meets, _mm_cmple_ps(_mm_loadu_ps(min_y + k), _mm_set1_ps(high_y)));
    meets = _mm_and_ps(meets, _mm_cmpge_ps(_mm_loadu_ps(max_y + k), _mm_set1_ps(low_y)));
    bits |= unsigned(_mm_movemask_ps(meets)) << k;
  }
#else
  for (int k = 0; k < arity; ++k) {
    const bool meets = min_x[k] <= high_x && max_x[k] >= low_x && min_y[k] <= high_y && max_y[k] >= low_y;
    bits |= unsigned(meets) << k;
  }
#endif
  return bits;
}

template <class Window, class Meets, class Visit>
void SiteBoxes::search_nearest(Vector<double> from, Memory& memory, Window&& window, Meets&& meets,
                               Visit&& visit) const {
  auto& heap = memory.heap_;
  heap.clear();
  std::uint32_t changes = 0;
  const auto consider = [&](std::uint32_t level, std::uint32_t i) {
    const Box b = box(level, i);
    if (!meets(b)) return;
    heap.push_back({entry(squared_distance(from, b), level, i), changes});
    std::push_heap(heap.begin(), heap.end(), std::greater<>{});
  };
  for (std::uint32_t i = 0; i < arity; ++i) consider(std::uint32_t(levels_.size() - 1), i);
  while (!heap.empty()) {
    std::pop_heap(heap.begin(), heap.end(), std::greater<>{});
    const auto waiting = heap.back();
    heap.pop_back();
    const std::uint32_t e = std::uint32_t(waiting.entry), level = e >> index_bits, index = e & ((1u << index_bits) - 1);
    if (waiting.changes != changes && !meets(box(level, index))) continue;  // what was found meanwhile rules it out
    if (level == 0) {
      if (visit(index)) ++changes;
      continue;
    }
    for (unsigned bits = levels_[level - 1][index].meeting(window()); bits != 0; bits &= bits - 1) {
      consider(level - 1, index * arity + std::uint32_t(std::countr_zero(bits)));
    }
  }
}

template <class Window, class Meets, class Visit>
void SiteBoxes::search_near(Vector<double> from, Memory& memory, Window&& window, Meets&& meets, Visit&& visit) const {
  std::vector<std::uint64_t>& stack = memory.stack_;
  stack.clear();
  const auto consider = [&](std::uint32_t level, std::uint32_t i) {
    const Box b = box(level, i);
    if (!meets(b)) return;
    stack.push_back(entry(squared_distance(from, b), level, i));
  };
  const auto nearest_last = [&](std::size_t first) {
    std::sort(stack.begin() + std::ptrdiff_t(first), stack.end(), std::greater<>{});
  };
  find_start(window(), memory);
  for (const std::uint32_t i : memory.start_) {
    if (meeting(box(memory.level_, i), window())) consider(memory.level_, i);
  }
  nearest_last(0);
  bool narrower = false;
  while (!stack.empty()) {
    const std::uint32_t e = std::uint32_t(stack.back()), level = e >> index_bits, index = e & ((1u << index_bits) - 1);
    stack.pop_back();
    if (narrower && !meets(box(level, index))) continue;  // what was found meanwhile rules it out
    if (level == 0) {
      narrower = visit(index) || narrower;
      continue;
    }
    const std::size_t first = stack.size();
    for (unsigned bits = levels_[level - 1][index].meeting(window()); bits != 0; bits &= bits - 1) {
      consider(level - 1, index * arity + std::uint32_t(std::countr_zero(bits)));
    }
    nearest_last(first);
  }
}

}  // namespace krepl::voronoi
