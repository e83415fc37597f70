#include "voronoi/sites.hpp"

#include <algorithm>

#include "kernel/pages.hpp"
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
  find_corners(quiet);
}

void Sites::find_corners(const Context& context) {
  const std::size_t n = in_.vertices().size(), segments = in_.side_count() / 2;
  kernel::resize_pages(context, corner_, 4 * segments, none);
  std::vector<Index> begin(n + 1, 0), outgoing(2 * segments);
  for (Index s = 0; s < segments; ++s) ++begin[in_.site(s).a], ++begin[in_.site(s).b];
  Index total = 0;
  for (Index& b : begin) total += b, b = total;  // ends of the buckets; filling moves them to the starts
  for (Index s = Index(segments); s-- > 0;) {
    outgoing[--begin[in_.site(s).a]] = 2 * s;
    outgoing[--begin[in_.site(s).b]] = 2 * s + 1;
  }
  kernel::parallel_blocks(context, n, 1 << 14, [&](std::size_t first, std::size_t last) {
    for (std::size_t v = first; v < last; ++v)
      find_corners_of(Index(v), {outgoing.data() + begin[v], begin[v + 1] - begin[v]});
  });
}

void Sites::find_corners_of(Index v, std::span<Index> outgoing) {
  if (outgoing.empty()) return;
  if (outgoing.size() > 2) {  // counter-clockwise, from the first one
    const auto head = [&](Index side) { return in_.ends(side).to; };
    const auto half = [&](Index side) {
      return side == outgoing[0] ? 0 : in_.turns_left(v, head(outgoing[0]), head(side)) ? 1 : 2;
    };
    std::stable_sort(outgoing.begin() + 1, outgoing.end(), [&](Index a, Index b) {
      const int i = half(a), k = half(b);
      return i != k ? i < k : in_.turns_left(v, head(a), head(b));
    });
  }
  for (std::size_t i = 0; i < outgoing.size(); ++i) {
    // The gap between two lies on the right of the first as it comes in and of the second as it goes out.
    const Index in = outgoing[i] ^ 1u, out = outgoing[(i + 1) % outgoing.size()];
    corner_[2 * in + 1] = out, corner_[2 * out] = in;
  }
  const auto sector = in_.sector(v);
  if (sector.before != none) corner_[2 * sector.before + 1] = corner_[2 * sector.after] = in_.circle(v);
}

}  // namespace krepl::voronoi
