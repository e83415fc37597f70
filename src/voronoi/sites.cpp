#include "voronoi/sites.hpp"

#include "kernel/parallel.hpp"

namespace krepl::voronoi {

Sites::Sites(const Instance& instance, const Context& context)
    : in_(instance), horizon_(instance.extent() > 0 ? horizon_in_extents * instance.extent() : 1) {
  const std::size_t segments = instance.side_count() / 2, vertices = instance.vertices().size();
  kernel::resize_pages(context, direction_, segments);
  kernel::resize_pages(context, owner_, vertices, none);
  kernel::resize_pages(context, moved_, vertices);
  Context quiet;
  quiet.threads = context.threads;
  kernel::parallel_blocks(quiet, segments, 1 << 14, [&](std::size_t first, std::size_t last) {
    for (std::size_t s = first; s < last; ++s) direction_[s] = unit<double>(Index(s));
  });
  kernel::parallel_blocks(quiet, vertices, 1 << 14, [&](std::size_t first, std::size_t last) {
    for (std::size_t v = first; v < last; ++v) {
      const Index before = instance.sector(Index(v)).before;
      if (before != none && instance.is_side(before)) owner_[v] = before >> 1;
      const Point p = instance.vertices()[v];
      const Vector<double> by = instance.move(Index(v));
      moved_[v] = {kernel::DoubleDouble::sum(p.x, by.x), kernel::DoubleDouble::sum(p.y, by.y)};
    }
  });
  for (Index i = Index(segments); i < instance.site_count(); ++i) owner_[instance.site(i).a] = i;
}

}  // namespace krepl::voronoi
