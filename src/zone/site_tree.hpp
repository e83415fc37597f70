#pragma once

#include <cstdint>
#include <vector>

#include "krepl/context.hpp"
#include "zone/instance.hpp"

namespace krepl::zone {

/// A packed tree of bounding boxes, eight children a node, over the sites in their (Hilbert) order, in single precision
/// rounded outwards: 18.3 bytes a site.
class SiteTree {
 public:
  /// Where sites are sought: within `reach` of the centre and within `margin` of the box. Made by region(), which adds
  /// what rounding to single precision may lose.
  struct Region {
    float x, y;           // centre, from which the nearest come first
    float reach_squared;
    float min_x, min_y, max_x, max_y;
  };

  SiteTree(const Instance& instance, const Context& context);

  /// Region of all sites within `radius` of an element with the given centre, half width and box.
  Region region(Vector<double> centre, double half_width, Vector<double> low, Vector<double> high, double radius) const;

  /// Visits sites whose box meets the region, by growing distance of their boxes from the centre, until visit(site) returns
  /// false. `heap` is scratch memory that callers reuse.
  struct Entry {
    float distance;
    std::uint32_t level;  // 0: a site
    std::uint32_t index;
    bool operator<(const Entry& e) const { return distance > e.distance; }  // for a min-heap
  };
  template <class Visit>
  void visit_nearest(const Region& region, std::vector<Entry>& heap, Visit&& visit) const;

 private:
  static constexpr int arity = 8;
  struct Node {
    float min_x[arity], min_y[arity], max_x[arity], max_y[arity];
  };
  void open(const Node& node, std::uint32_t first_child, std::uint32_t child_level, const Region& r,
            std::vector<Entry>& heap) const;

  float slack_;
  std::vector<std::vector<Node>> levels_;  // levels_[0]: boxes of sites; the last level is one node
};

template <class Visit>
void SiteTree::visit_nearest(const Region& region, std::vector<Entry>& heap, Visit&& visit) const {
  heap.clear();
  heap.push_back({0.f, std::uint32_t(levels_.size()), 0});
  while (!heap.empty()) {
    std::pop_heap(heap.begin(), heap.end());
    const Entry e = heap.back();
    heap.pop_back();
    if (e.level == 0) {
      if (!visit(e.index)) return;
    } else {
      open(levels_[e.level - 1][e.index], e.index * arity, e.level - 1, region, heap);
    }
  }
}

}  // namespace krepl::zone
