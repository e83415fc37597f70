#include "mill/ring_order.hpp"

#include <algorithm>
#include <cmath>

#include "mill/boundary.hpp"

namespace krepl::mill {
namespace {

struct Box {
  Point low, high;
  bool contains(const Box& b) const {
    return low.x <= b.low.x && low.y <= b.low.y && high.x >= b.high.x && high.y >= b.high.y;
  }
};

Box box_of(const std::vector<Point>& ring) {
  Box box{ring.front(), ring.front()};
  for (const Point p : ring) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
  }
  return box;
}

}  // namespace

std::vector<std::size_t> order_rings(const std::vector<std::vector<Point>>& rings) {
  const std::size_t n = rings.size();
  std::vector<Box> boxes;
  for (const auto& ring : rings) boxes.push_back(box_of(ring));
  std::vector<std::vector<std::size_t>> around(n);  // rings that contain each
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b)
      if (a != b && boxes[b].contains(boxes[a]) && is_inside(rings[b], rings[a].front())) around[a].push_back(b);
  // The innermost of those around a ring is the one that has the most around itself.
  std::vector<std::vector<std::size_t>> inside(n + 1);
  for (std::size_t a = n; a-- > 0;) {
    std::size_t parent = n;
    for (const std::size_t b : around[a])
      if (parent == n || around[b].size() > around[parent].size()) parent = b;
    inside[parent].push_back(a);
  }
  std::vector<std::size_t> order, waiting = inside[n];
  while (!waiting.empty()) {
    const std::size_t r = waiting.back();
    waiting.pop_back();
    order.push_back(r);
    waiting.insert(waiting.end(), inside[r].begin(), inside[r].end());
  }
  return order;
}

}  // namespace krepl::mill
