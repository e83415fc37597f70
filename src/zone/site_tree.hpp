#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <vector>

#include "krepl/context.hpp"
#include "zone/instance.hpp"

namespace krepl::zone {

/// A packed tree of bounding boxes, eight children a node, over the sites in their (Hilbert) order, in single precision
/// rounded outwards: 18.3 bytes a site. At most 2^28 sites. A box is widened by what its site's radius exceeds the least.
class SiteTree {
 public:
  /// Where sites are sought: within `reach` of the centre and within `margin` of the box. Made by region(), which adds
  /// what rounding to single precision may lose.
  struct Region {
    float x, y;           // centre, from which the nearest come first
    float reach_squared;
    float min_x, min_y, max_x, max_y;
  };

  /// A node or site to visit, as one number that orders by squared distance (a non-negative float orders like its bits),
  /// then by level and index: sites are level 0.
  using Entry = std::uint64_t;

  SiteTree(const Instance& instance, const Context& context);

  /// Region of all sites within `radius` of an element with the given centre, half width and box.
  Region region(Vector<double> centre, double half_width, Vector<double> low, Vector<double> high, double radius) const;

  /// A few nodes that hold all sites of a region: where the searches of a group of neighbouring elements start, instead of
  /// at the root.
  class Frontier;
  Frontier frontier(const Region& region) const;

  /// Visits sites whose box meets the region, by growing distance of their boxes from the centre, until visit(site) returns
  /// false. The visitor may shrink the region meanwhile. `heap` is scratch memory that callers reuse.
  template <class Visit>
  void visit_nearest(const Frontier& frontier, const Region& region, std::vector<Entry>& heap, Visit&& visit) const;

 private:
  static constexpr int arity = 8;
  static constexpr unsigned index_bits = 28;
  static Entry entry(float distance, std::uint32_t level, std::uint32_t index) {
    return std::uint64_t{std::bit_cast<std::uint32_t>(distance)} << 32 | level << index_bits | index;
  }
  struct Node {
    float min_x[arity], min_y[arity], max_x[arity], max_y[arity];
  };
  /// Which children meet the region, as bits, and their squared distances from its centre.
  static unsigned meeting(const Node& node, const Region& region, float distance[arity]);

  float slack_;
  std::vector<std::vector<Node>> levels_;  // levels_[0]: boxes of sites; the last level is one node
};

class SiteTree::Frontier {
 private:
  friend class SiteTree;
  static constexpr int nodes = 2;
  struct Member {
    std::uint32_t level, index;
  };
  std::array<Node, nodes> boxes_;  // of the members, eight each
  std::array<Member, nodes * arity> members_;
  int count_ = 0;
};

template <class Visit>
void SiteTree::visit_nearest(const Frontier& frontier, const Region& region, std::vector<Entry>& heap,
                             Visit&& visit) const {
  heap.clear();
  float distance[arity];
  for (int n = 0; n * arity < frontier.count_; ++n) {
    for (unsigned bits = meeting(frontier.boxes_[n], region, distance); bits != 0; bits &= bits - 1) {
      const int k = __builtin_ctz(bits);
      const auto m = frontier.members_[n * arity + k];
      heap.push_back(entry(distance[k], m.level, m.index));
    }
  }
  std::make_heap(heap.begin(), heap.end(), std::greater<>{});
  while (!heap.empty()) {
    std::pop_heap(heap.begin(), heap.end(), std::greater<>{});
    const Entry e = heap.back();
    heap.pop_back();
    const std::uint32_t level = std::uint32_t(e) >> index_bits, index = std::uint32_t(e) & ((1u << index_bits) - 1);
    if (level == 0) {
      if (!visit(index)) return;
      continue;
    }
    for (unsigned bits = meeting(levels_[level - 1][index], region, distance); bits != 0; bits &= bits - 1) {
      const int k = __builtin_ctz(bits);
      heap.push_back(entry(distance[k], level - 1, index * arity + std::uint32_t(k)));
      std::push_heap(heap.begin(), heap.end(), std::greater<>{});
    }
  }
}

}  // namespace krepl::zone
