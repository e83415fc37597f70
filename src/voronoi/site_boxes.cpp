#include "voronoi/site_boxes.hpp"

#include <cmath>
#include <limits>

#include "kernel/parallel.hpp"

namespace krepl::voronoi {
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

}  // namespace

SiteBoxes::SiteBoxes(const Instance& instance, const Context& context) {
  Context quiet;
  quiet.threads = context.threads;
  std::size_t count = instance.site_count();
  do {
    const std::size_t nodes = (count + arity - 1) / arity;
    std::vector<Node> level(nodes);
    const std::vector<Node>* below = levels_.empty() ? nullptr : &levels_.back();
    kernel::parallel_blocks(quiet, count, 1 << 12, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        Node& n = level[i / arity];
        const std::size_t k = i % arity;
        if (below == nullptr) {
          const auto s = instance.site(Index(i));
          const Point a = instance.vertices()[s.a], b = instance.vertices()[s.b];
          n.min_x[k] = down(std::min(a.x, b.x)), n.max_x[k] = up(std::max(a.x, b.x));
          n.min_y[k] = down(std::min(a.y, b.y)), n.max_y[k] = up(std::max(a.y, b.y));
          continue;
        }
        const Node& c = (*below)[i];
        const std::size_t used = std::min<std::size_t>(arity, count_.back() - i * arity);
        n.min_x[k] = *std::min_element(c.min_x, c.min_x + used), n.max_x[k] = *std::max_element(c.max_x, c.max_x + used);
        n.min_y[k] = *std::min_element(c.min_y, c.min_y + used), n.max_y[k] = *std::max_element(c.max_y, c.max_y + used);
      }
    });
    levels_.push_back(std::move(level));
    count_.push_back(std::uint32_t(count));
    count = nodes;
  } while (count > 1);
}

}  // namespace krepl::voronoi
