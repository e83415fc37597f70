#include "zone/site_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/parallel.hpp"

namespace krepl::zone {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

float down(double x) {
  const float f = float(x);
  return double(f) > x ? std::nextafter(f, -infinity) : f;
}
float up(double x) {
  const float f = float(x);
  return double(f) < x ? std::nextafter(f, infinity) : f;
}

using Lanes = float __attribute__((vector_size(32)));
using Mask = std::int32_t __attribute__((vector_size(32)));

Lanes load(const float* p) {
  Lanes v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}
Lanes all(float x) { return Lanes{} + x; }
Lanes positive(Lanes v) { return v > Lanes{} ? v : Lanes{}; }
Lanes larger(Lanes a, Lanes b) { return a > b ? a : b; }

}  // namespace

SiteTree::SiteTree(const Instance& instance, const Context& context) {
  // Boxes are rounded outwards; the region's own numbers are off by half a unit in the last place each.
  slack_ = float(instance.extent() + instance.radius()) * 0x1p-21f;

  Context quiet;
  quiet.threads = context.threads;
  const std::size_t sites = instance.site_count();
  std::size_t count = sites;
  do {
    const std::size_t nodes = (count + arity - 1) / arity;
    std::vector<Node> level(nodes);
    const std::vector<Node>* below = levels_.empty() ? nullptr : &levels_.back();
    kernel::parallel_blocks(quiet, nodes, 1 << 12, [&](std::size_t first, std::size_t last) {
      for (std::size_t n = first; n < last; ++n) {
        for (int k = 0; k < arity; ++k) {
          const std::size_t child = n * arity + std::size_t(k);
          float low_x = infinity, low_y = infinity, high_x = -infinity, high_y = -infinity;
          if (child < count && below == nullptr) {
            const auto s = instance.site(Index(child));
            const Point a = instance.vertices()[s.a], b = instance.vertices()[s.b];
            low_x = down(std::min(a.x, b.x)), high_x = up(std::max(a.x, b.x));
            low_y = down(std::min(a.y, b.y)), high_y = up(std::max(a.y, b.y));
          } else if (child < count) {
            const Node& c = (*below)[child];
            low_x = *std::min_element(c.min_x, c.min_x + arity), high_x = *std::max_element(c.max_x, c.max_x + arity);
            low_y = *std::min_element(c.min_y, c.min_y + arity), high_y = *std::max_element(c.max_y, c.max_y + arity);
          }
          level[n].min_x[k] = low_x, level[n].min_y[k] = low_y;
          level[n].max_x[k] = high_x, level[n].max_y[k] = high_y;
        }
      }
    });
    levels_.push_back(std::move(level));
    count = nodes;
  } while (count > 1);
}

SiteTree::Region SiteTree::region(Vector<double> centre, double half_width, Vector<double> low, Vector<double> high,
                                  double radius) const {
  const float reach = float((radius + half_width) * (1 + 0x1p-20)) + slack_;
  const float margin = float(radius * (1 + 0x1p-20)) + slack_;
  return {float(centre.x),      float(centre.y),      reach * reach * (1 + 0x1p-20f), float(low.x) - margin,
          float(low.y) - margin, float(high.x) + margin, float(high.y) + margin};
}

void SiteTree::open(const Node& node, std::uint32_t first_child, std::uint32_t child_level, const Region& r,
                    std::vector<Entry>& heap) const {
  const Lanes min_x = load(node.min_x), min_y = load(node.min_y), max_x = load(node.max_x), max_y = load(node.max_y);
  const Lanes dx = positive(larger(min_x - r.x, all(r.x) - max_x));
  const Lanes dy = positive(larger(min_y - r.y, all(r.y) - max_y));
  const Lanes distance = dx * dx + dy * dy;
  const Mask meets = (distance <= all(r.reach_squared)) & (min_x <= all(r.max_x)) & (max_x >= all(r.min_x)) &
                     (min_y <= all(r.max_y)) & (max_y >= all(r.min_y));
  for (int k = 0; k < arity; ++k) {
    if (!meets[k]) continue;
    heap.push_back({distance[k], child_level, first_child + std::uint32_t(k)});
    std::push_heap(heap.begin(), heap.end());
  }
}

}  // namespace krepl::zone
