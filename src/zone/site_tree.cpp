#include "zone/site_tree.hpp"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/outward_rounding.hpp"
#include "kernel/parallel.hpp"

namespace krepl::zone {

using kernel::float_above;
using kernel::float_below;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

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
            // Sought within the least radius, so wider cigars have wider boxes.
            const double more = instance.site_radius(Index(child)) - instance.least_radius();
            low_x = float_below(std::min(a.x, b.x) - more), high_x = float_above(std::max(a.x, b.x) + more);
            low_y = float_below(std::min(a.y, b.y) - more), high_y = float_above(std::max(a.y, b.y) + more);
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

SiteTree::Frontier SiteTree::frontier(const Region& region) const {
  constexpr std::size_t most = Frontier::nodes * arity;
  std::vector<Frontier::Member> members{{std::uint32_t(levels_.size()), 0}}, below;
  std::vector<const float*> boxes, boxes_below;  // min_x of the member; the other bounds follow at distance arity
  float distance[arity];
  while (members[0].level > 1 || boxes.empty()) {
    below.clear();
    boxes_below.clear();
    for (const auto m : members) {
      const Node& node = levels_[m.level - 1][m.index];
      for (unsigned bits = meeting(node, region, distance); bits != 0; bits &= bits - 1) {
        const int k = __builtin_ctz(bits);
        below.push_back({m.level - 1, m.index * arity + std::uint32_t(k)});
        boxes_below.push_back(node.min_x + k);
      }
    }
    if (below.empty() || below.size() > most) break;
    members.swap(below);
    boxes.swap(boxes_below);
  }
  Frontier f;
  f.count_ = int(boxes.size());
  for (std::size_t i = 0; i < most; ++i) {
    Node& node = f.boxes_[i / arity];
    const std::size_t k = i % arity;
    const bool used = i < boxes.size();
    node.min_x[k] = used ? boxes[i][0] : infinity, node.min_y[k] = used ? boxes[i][arity] : infinity;
    node.max_x[k] = used ? boxes[i][2 * arity] : -infinity, node.max_y[k] = used ? boxes[i][3 * arity] : -infinity;
    if (used) f.members_[i] = members[i];
  }
  return f;
}

unsigned SiteTree::meeting(const Node& node, const Region& r, float distance[arity]) {
  unsigned bits = 0;
#ifdef __SSE2__
  const __m128 zero = _mm_setzero_ps();
  for (int k = 0; k < arity; k += 4) {
    const __m128 min_x = _mm_loadu_ps(node.min_x + k), min_y = _mm_loadu_ps(node.min_y + k);
    const __m128 max_x = _mm_loadu_ps(node.max_x + k), max_y = _mm_loadu_ps(node.max_y + k);
    const __m128 x = _mm_set1_ps(r.x), y = _mm_set1_ps(r.y);
    const __m128 dx = _mm_max_ps(_mm_max_ps(_mm_sub_ps(min_x, x), _mm_sub_ps(x, max_x)), zero);
    const __m128 dy = _mm_max_ps(_mm_max_ps(_mm_sub_ps(min_y, y), _mm_sub_ps(y, max_y)), zero);
    const __m128 d = _mm_add_ps(_mm_mul_ps(dx, dx), _mm_mul_ps(dy, dy));
    __m128 meets = _mm_cmple_ps(d, _mm_set1_ps(r.reach_squared));
    meets = _mm_and_ps(meets, _mm_cmple_ps(min_x, _mm_set1_ps(r.max_x)));
    meets = _mm_and_ps(meets, _mm_cmpge_ps(max_x, _mm_set1_ps(r.min_x)));
    meets = _mm_and_ps(meets, _mm_cmple_ps(min_y, _mm_set1_ps(r.max_y)));
    meets = _mm_and_ps(meets, _mm_cmpge_ps(max_y, _mm_set1_ps(r.min_y)));
    _mm_storeu_ps(distance + k, d);
    bits |= unsigned(_mm_movemask_ps(meets)) << k;
  }
#else
  for (int k = 0; k < arity; ++k) {
    const float dx = std::max(std::max(node.min_x[k] - r.x, r.x - node.max_x[k]), 0.f);
    const float dy = std::max(std::max(node.min_y[k] - r.y, r.y - node.max_y[k]), 0.f);
    distance[k] = dx * dx + dy * dy;
    const bool meets = distance[k] <= r.reach_squared && node.min_x[k] <= r.max_x && node.max_x[k] >= r.min_x &&
                       node.min_y[k] <= r.max_y && node.max_y[k] >= r.min_y;
    bits |= unsigned(meets) << k;
  }
#endif
  return bits;
}

}  // namespace krepl::zone
