#include "voronoi/site_boxes.hpp"

#include <cmath>
#include <limits>

#include "kernel/outward_rounding.hpp"
#include "kernel/parallel.hpp"

namespace krepl::voronoi {

using kernel::float_above;
using kernel::float_below;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

}  // namespace

SiteBoxes::SearchWindow::SearchWindow(const Box& box)
    : Box(box),
      low_x(float_below(centre.x - half.x)),
      high_x(float_above(centre.x + half.x)),
      low_y(float_below(centre.y - half.y)),
      high_y(float_above(centre.y + half.y)) {}

SiteBoxes::SiteBoxes(const Instance& instance, const Context& context) {
  Context quiet;
  quiet.threads = context.threads;
  std::size_t count = instance.site_count();
  do {
    const std::size_t nodes = (count + arity - 1) / arity;
    Node empty;
    std::fill(empty.min_x, empty.min_x + arity, infinity), std::fill(empty.max_x, empty.max_x + arity, -infinity);
    std::fill(empty.min_y, empty.min_y + arity, infinity), std::fill(empty.max_y, empty.max_y + arity, -infinity);
    std::vector<Node> level(nodes, empty);
    const std::vector<Node>* below = levels_.empty() ? nullptr : &levels_.back();
    kernel::parallel_blocks(quiet, count, 1 << 12, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        Node& n = level[i / arity];
        const std::size_t k = i % arity;
        if (below == nullptr) {
          const auto s = instance.site(Index(i));
          const Point a = instance.vertices()[s.a], b = instance.vertices()[s.b];
          n.min_x[k] = float_below(std::min(a.x, b.x)), n.max_x[k] = float_above(std::max(a.x, b.x));
          n.min_y[k] = float_below(std::min(a.y, b.y)), n.max_y[k] = float_above(std::max(a.y, b.y));
          continue;
        }
        const Node& c = (*below)[i];
        n.min_x[k] = *std::min_element(c.min_x, c.min_x + arity),
        n.max_x[k] = *std::max_element(c.max_x, c.max_x + arity);
        n.min_y[k] = *std::min_element(c.min_y, c.min_y + arity),
        n.max_y[k] = *std::max_element(c.max_y, c.max_y + arity);
      }
    });
    levels_.push_back(std::move(level));
    count = nodes;
  } while (count > 1);
}

void SiteBoxes::find_start(const Box& window, Memory& m) const {
  constexpr std::size_t most = 24;
  // Windows of neighbouring faces differ a little; one that is much smaller deserves an area of its own.
  const bool ample = m.area_.half.x > 8 * window.half.x && m.area_.half.y > 8 * window.half.y && m.level_ > 1;
  if (within(window, m.area_) && !ample) return;
  m.area_ = {window.centre, {2 * window.half.x, 2 * window.half.y}};
  const SearchWindow area(m.area_);
  m.level_ = std::uint32_t(levels_.size() - 1);
  m.start_.clear();
  for (unsigned bits = levels_.back()[0].meeting(area); bits != 0; bits &= bits - 1) {
    m.start_.push_back(std::uint32_t(std::countr_zero(bits)));
  }
  while (m.level_ > 1) {
    m.below_.clear();
    for (const std::uint32_t i : m.start_) {
      for (unsigned bits = levels_[m.level_ - 1][i].meeting(area); bits != 0; bits &= bits - 1) {
        m.below_.push_back(i * arity + std::uint32_t(std::countr_zero(bits)));
      }
    }
    if (m.below_.size() > most) break;
    m.start_.swap(m.below_);
    --m.level_;
  }
}

}  // namespace krepl::voronoi
