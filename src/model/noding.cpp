#include "model/noding.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/orientation.hpp"
#include "kernel/parallel.hpp"
#include "model/segment_tree.hpp"

namespace krepl::model {
namespace {

using Index = std::uint32_t;
using Wide = __int128;  // products of two differences need 110 bits
using UnsignedWide = unsigned __int128;

constexpr std::size_t block_size = 4096;

/// (b - a) x (c - a)
Wide cross(GridPoint a, GridPoint b, GridPoint c) {
  return Wide(b.x - a.x) * (c.y - a.y) - Wide(b.y - a.y) * (c.x - a.x);
}

/// A product of 128 and 64 bits.
struct Product {
  UnsignedWide high;
  std::uint64_t low;
  friend auto operator<=>(const Product&, const Product&) = default;
};
Product multiply(UnsignedWide a, std::uint64_t b) {
  const UnsignedWide low = UnsignedWide(std::uint64_t(a)) * b;
  return {(a >> 64) * b + (low >> 64), std::uint64_t(low)};
}

/// length * part / whole to the nearest integer, exactly; halves go up if `up`, else down. 0 < part < whole.
std::int64_t scaled(std::int64_t length, UnsignedWide part, UnsignedWide whole, bool up) {
  const Product twice = multiply(part, 2 * std::uint64_t(length));
  // The wanted k has whole (2k - 1) <= twice < whole (2k + 1), or the same with the equality on the other side.
  const auto too_large = [&](std::int64_t k) {
    if (k <= 0) return false;
    const Product least = multiply(whole, std::uint64_t(2 * k - 1));
    return up ? least > twice : least >= twice;
  };
  auto k = std::int64_t(static_cast<long double>(length) *
                        (static_cast<long double>(part) / static_cast<long double>(whole)));
  while (too_large(k)) --k;
  while (!too_large(k + 1)) ++k;
  return k;
}

/// a + (b - a) * part / whole; the pixel's lower and left sides belong to it, so halves go up.
std::int64_t between(std::int64_t a, std::int64_t b, UnsignedWide part, UnsignedWide whole) {
  return b >= a ? a + scaled(b - a, part, whole, true) : a - scaled(a - b, part, whole, false);
}

bool cross_inside(GridPoint a, GridPoint b, GridPoint c, GridPoint d) {
  const auto opposite = [](int s, int t) { return s * t < 0; };
  const Point p = SegmentTree::point(a), q = SegmentTree::point(b), r = SegmentTree::point(c),
              s = SegmentTree::point(d);
  return opposite(kernel::orientation(p, q, r), kernel::orientation(p, q, s)) &&
         opposite(kernel::orientation(r, s, p), kernel::orientation(r, s, q));
}

/// Runs `work(i, results of i's block)` for all i and puts the blocks' results one after the other.
template <class T, class Work>
std::optional<std::vector<T>> gather(const Context& context, std::size_t count, Work work) {
  std::vector<std::vector<T>> found((count + block_size - 1) / block_size);
  Context quiet = context;
  quiet.progress = nullptr;
  const bool done = kernel::parallel_blocks(quiet, count, block_size, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) work(i, found[first / block_size]);
  });
  if (!done) return std::nullopt;
  std::vector<T> all;
  for (const std::vector<T>& block : found) all.insert(all.end(), block.begin(), block.end());
  return all;
}

std::optional<std::vector<GridPoint>> crossings(std::span<const GridPoint> vertices,
                                                std::span<const GridSegment> segments, const SegmentTree& tree,
                                                const Context& context) {
  const auto add = [&](std::size_t place, std::vector<GridPoint>& found) {
    const GridSegment s = segments[tree.segment(place)];
    tree.tree().visit_meeting(SegmentTree::box(vertices, s), [&](std::size_t other) {
      if (other <= place) return;
      const GridSegment t = segments[tree.segment(other)];
      if (s.a == t.a || s.a == t.b || s.b == t.a || s.b == t.b) return;
      const GridPoint a = vertices[s.a], b = vertices[s.b], c = vertices[t.a], d = vertices[t.b];
      if (cross_inside(a, b, c, d)) found.push_back(rounded_crossing(a, b, c, d));
    });
  };
  return gather<GridPoint>(context, segments.size(), add);
}

/// Appends the points that are not among the vertices yet, each once.
void add_new(std::vector<GridPoint>& vertices, std::vector<GridPoint> points) {
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::vector<GridPoint> known = vertices;
  std::sort(known.begin(), known.end());
  std::set_difference(points.begin(), points.end(), known.begin(), known.end(), std::back_inserter(vertices));
}

struct Cut {
  Index segment, vertex;
};

/// All (segment, vertex) where the segment passes the vertex's pixel, its own ends among them.
std::optional<std::vector<Cut>> cuts(std::span<const GridPoint> vertices, std::span<const GridSegment> segments,
                                     const SegmentTree& tree, const Context& context) {
  const auto add = [&](std::size_t v, std::vector<Cut>& found) {
    kernel::Box box;
    box.add(SegmentTree::point(vertices[v]));
    tree.tree().visit_meeting(box, [&](std::size_t place) {
      const GridSegment s = segments[tree.segment(place)];
      if (passes_pixel(vertices[s.a], vertices[s.b], vertices[v])) found.push_back({tree.segment(place), Index(v)});
    });
  };
  return gather<Cut>(context, vertices.size(), add);
}

}  // namespace

bool passes_pixel(GridPoint a, GridPoint b, GridPoint c) {
  if (c.x < std::min(a.x, b.x) || c.x > std::max(a.x, b.x) || c.y < std::min(a.y, b.y) || c.y > std::max(a.y, b.y)) {
    return false;  // whole numbers: a segment that reaches the pixel's half-open square reaches its centre's row and
                   // column
  }
  const double dx = double(b.x - a.x), dy = double(b.y - a.y);
  const double left = dx * double(c.y - a.y), right = dy * double(c.x - a.x);
  const double span = std::abs(dx) + std::abs(dy);
  if (std::abs(left - right) - 0x1p-50 * (std::abs(left) + std::abs(right)) > span) return false;  // twice too far
  const Wide twice = 2 * cross(a, b, c), width = Wide(std::abs(b.x - a.x)) + std::abs(b.y - a.y);
  if (twice < width && -twice < width) return true;
  if (twice != width && -twice != width) return false;
  // The line touches one corner: only the lower left one belongs to the pixel. (b - a) x (corner - a), doubled:
  return twice - Wide(b.x - a.x) + Wide(b.y - a.y) == 0;
}

GridPoint rounded_crossing(GridPoint a, GridPoint b, GridPoint c, GridPoint d) {
  // a + (b - a) t with t = (c - a) x (d - c) / (b - a) x (d - c), between 0 and 1
  Wide part = Wide(c.x - a.x) * (d.y - c.y) - Wide(c.y - a.y) * (d.x - c.x);
  Wide whole = Wide(b.x - a.x) * (d.y - c.y) - Wide(b.y - a.y) * (d.x - c.x);
  if (whole < 0) part = -part, whole = -whole;
  const auto p = UnsignedWide(part), w = UnsignedWide(whole);
  return {between(a.x, b.x, p, w), between(a.y, b.y, p, w)};
}

std::optional<Noding> node_segments(std::vector<GridPoint> vertices, std::span<const GridSegment> segments,
                                    const Context& context) {
  const SegmentTree tree(vertices, segments);
  auto found = crossings(vertices, segments, tree, context);
  if (!found) return std::nullopt;
  const std::size_t given = vertices.size();
  add_new(vertices, std::move(*found));
  auto all = cuts(vertices, segments, tree, context);
  if (!all) return std::nullopt;

  Noding result;
  for (const Cut& cut : *all) {
    const GridSegment s = segments[cut.segment];
    if (cut.vertex < given && cut.vertex != s.a && cut.vertex != s.b) ++result.touches;
  }
  // A segment passes pixels in the order of their columns, and in a column in that of their rows, each in its own
  // sense.
  std::sort(all->begin(), all->end(), [&](const Cut& p, const Cut& q) {
    if (p.segment != q.segment) return p.segment < q.segment;
    const GridPoint a = vertices[segments[p.segment].a], b = vertices[segments[p.segment].b];
    const GridPoint u = vertices[p.vertex], v = vertices[q.vertex];
    if (u.x != v.x) return (u.x < v.x) == (a.x < b.x);
    return u.y != v.y && (u.y < v.y) == (a.y < b.y);
  });
  for (std::size_t i = 1; i < all->size(); ++i) {
    const Cut &p = (*all)[i - 1], &q = (*all)[i];
    if (p.segment == q.segment) result.fragments.push_back({p.vertex, q.vertex, p.segment});
  }
  result.vertices = std::move(vertices);
  return result;
}

}  // namespace krepl::model
