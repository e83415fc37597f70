#include "krepl/network.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/box_tree.hpp"
#include "kernel/hilbert.hpp"
#include "kernel/pages.hpp"
#include "kernel/parallel.hpp"
#include "kernel/radix_sort.hpp"
#include "model/exact_origin.hpp"

namespace krepl {
namespace {

constexpr std::size_t block_size = 1 << 16;
constexpr std::size_t most_vertices = std::size_t{1} << 28;  // what searches pack into one number

using kernel::Box;

/// Maps coordinates to the Hilbert curve's grid.
class Grid {
 public:
  Grid(const Box& box, Point origin) : low_{box.min_x - origin.x, box.min_y - origin.y} {
    const double width = std::max(box.max_x - box.min_x, box.max_y - box.min_y);
    scale_ = width > 0 ? 65535.0 / width : 0.0;
    if (!std::isfinite(scale_)) scale_ = 0.0;
  }
  std::uint32_t key(Point p) const { return kernel::HilbertCurve::index(cell(p.x - low_.x), cell(p.y - low_.y)); }

 private:
  std::uint32_t cell(double d) const { return std::uint32_t(std::clamp(d * scale_, 0.0, 65535.0)); }
  Point low_;
  double scale_;
};

struct Welded {
  std::vector<Point> vertices;
  std::vector<std::uint32_t> position;  // per vertex: its first place in the input
  std::vector<std::uint32_t> chain;     // per input vertex: its vertex
};

/// Sorts the input vertices along the Hilbert curve and gives equal ones the same number.
Welded weld(const std::vector<Point>& points, const Grid& grid, const Context& context) {
  const std::size_t n = points.size();
  std::vector<std::uint64_t> order;
  kernel::resize_pages(context, order, n);
  Context quiet;
  quiet.threads = context.threads;
  kernel::parallel_blocks(quiet, n, block_size, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) order[i] = std::uint64_t{grid.key(points[i])} << 32 | i;
  });
  kernel::radix_sort(order, 32, context);

  Welded w;
  kernel::reserve_pages(context, w.vertices, n);
  kernel::reserve_pages(context, w.position, n);
  kernel::resize_pages(context, w.chain, n);
  const auto before = [&](std::uint64_t i, std::uint64_t j) {
    const Point p = points[std::uint32_t(i)], q = points[std::uint32_t(j)];
    return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : i < j;
  };
  for (std::size_t i = 0; i < n;) {
    std::size_t j = i + 1;
    while (j < n && order[j] >> 32 == order[i] >> 32) ++j;
    if (j - i > 1) std::sort(order.begin() + std::ptrdiff_t(i), order.begin() + std::ptrdiff_t(j), before);
    for (std::size_t k = i; k < j; ++k) {
      const std::uint32_t at = std::uint32_t(order[k]);
      if (k == i || points[at] != points[std::uint32_t(order[k - 1])]) {
        w.vertices.push_back(points[at]);
        w.position.push_back(at);
      }
      w.chain[at] = std::uint32_t(w.vertices.size() - 1);
    }
    i = j;
  }
  return w;
}

}  // namespace

void Network::Builder::add_part(std::span<const Point> vertices, std::int64_t feature, bool ring) {
  if (vertices.empty()) return;
  part_begin_.push_back(std::uint32_t(points_.size()));
  part_feature_.push_back(feature);
  part_is_ring_.push_back(ring);
  points_.insert(points_.end(), vertices.begin(), vertices.end());
}

void Network::Builder::add_line(std::span<const Point> vertices, std::int64_t feature) {
  add_part(vertices, feature, false);
}

void Network::Builder::add_ring(std::span<const Point> vertices, std::int64_t feature) {
  add_part(vertices, feature, true);
}

void Network::Builder::add_point(Point p, std::int64_t feature) { add_part({&p, 1}, feature, false); }

Result<Network> Network::Builder::build(const Context& context) && {
  const std::size_t n = points_.size();
  if (n == 0) return Error{ErrorCode::input, "there is no vertex in the input", "", "give at least one point or line"};
  if (n > most_vertices) {
    return Error{ErrorCode::input, "there are more than 2^28 vertices in the input", "", "split the input"};
  }
  Network net;
  net.part_begin_ = std::move(part_begin_);
  net.part_begin_.push_back(std::uint32_t(n));
  net.part_feature_ = std::move(part_feature_);
  net.part_is_ring_ = std::move(part_is_ring_);
  net.has_polygons_ = std::find(net.part_is_ring_.begin(), net.part_is_ring_.end(), true) != net.part_is_ring_.end();

  Box box;
  for (std::size_t i = 0; i < n; ++i) {
    if (std::isfinite(points_[i].x) && std::isfinite(points_[i].y)) {
      box.add(points_[i]);
      continue;
    }
    const Source s = net.source_of(std::uint32_t(i));
    return Error{ErrorCode::input, "a coordinate is NaN or infinite",
                 "feature " + std::to_string(s.feature) + ", vertex " + std::to_string(s.vertex),
                 "remove or repair that vertex"};
  }
  net.origin_ = {exact_origin(box.min_x, box.max_x), exact_origin(box.min_y, box.max_y)};
  const double largest = std::max({std::abs(box.min_x), std::abs(box.max_x), std::abs(box.min_y), std::abs(box.max_y)});
  net.extent_ = std::max({std::abs(box.min_x - net.origin_.x), std::abs(box.max_x - net.origin_.x),
                          std::abs(box.min_y - net.origin_.y), std::abs(box.max_y - net.origin_.y)});
  if (!std::isfinite(2 * largest)) {
    return Error{ErrorCode::input, "the coordinates are too large for double precision", "", "scale the input down"};
  }
  net.resolution_ = std::nextafter(largest, std::numeric_limits<double>::infinity()) - largest;
  for (Point& p : points_) p = {p.x - net.origin_.x, p.y - net.origin_.y};

  Welded welded = weld(points_, Grid(box, net.origin_), context);
  points_ = {};
  net.chain_ = std::move(welded.chain);
  net.vertex_position_ = std::move(welded.position);
  net.vertices_ = std::move(welded.vertices);
  net.vertices_.shrink_to_fit();
  net.report_.input_vertices = n;
  net.report_.coinciding_vertices = n - net.vertices_.size();
  if (context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  net.index_segments(gaps_);
  return net;
}

void Network::index_segments(const std::vector<std::uint32_t>& gaps) {
  // Counting sort by the lower vertex; buckets are small (the degree), so they are sorted by comparison.
  struct Entry {
    std::uint32_t b, position;
  };
  const auto for_each_pair = [&](auto&& visit) {
    for (std::uint32_t p = 0; p + 1 < part_begin_.size(); ++p) {
      const std::uint32_t first = part_begin_[p], last = part_begin_[p + 1] - 1;
      auto gap = std::lower_bound(gaps.begin(), gaps.end(), first);
      for (std::uint32_t i = first; i < last; ++i) {
        if (gap == gaps.end() || *gap != i) visit(i, chain_[i], chain_[i + 1]);
        else ++gap;
      }
      if (part_is_ring_[p] && last > first + 1 && chain_[last] != chain_[first]) visit(last, chain_[last], chain_[first]);
    }
  };
  std::vector<std::uint32_t> begin(vertices_.size() + 1, 0);
  for_each_pair([&](std::uint32_t, std::uint32_t u, std::uint32_t v) {
    if (u == v) ++report_.repeated_vertices;
    else ++begin[std::min(u, v) + 1];
  });
  for (std::size_t v = 0; v < vertices_.size(); ++v) begin[v + 1] += begin[v];
  std::vector<Entry> entries(begin.back());
  for_each_pair([&](std::uint32_t i, std::uint32_t u, std::uint32_t v) {
    if (u != v) entries[begin[std::min(u, v)]++] = {std::max(u, v), i};
  });
  segments_.reserve(entries.size());
  segment_position_.reserve(entries.size());
  std::size_t from = 0;
  for (std::uint32_t a = 0; a < vertices_.size(); ++a) {  // begin[a] has moved on to the bucket's end
    const auto first = entries.begin() + std::ptrdiff_t(from), last = entries.begin() + std::ptrdiff_t(begin[a]);
    std::sort(first, last, [](const Entry& e, const Entry& f) {
      return e.b != f.b ? e.b < f.b : e.position < f.position;
    });
    for (auto e = first; e != last; ++e) {
      if (e != first && e->b == (e - 1)->b) {
        ++report_.duplicate_segments;
        continue;
      }
      segments_.push_back({a, e->b});
      segment_position_.push_back(e->position);
    }
    from = begin[a];
  }
}

Network::Source Network::source_of(std::uint32_t position) const {
  const auto next = std::upper_bound(part_begin_.begin(), part_begin_.end(), position);
  const auto part = std::uint32_t(next - part_begin_.begin()) - 1;
  return {part_feature_[part], part, position - part_begin_[part]};
}

Network::Source Network::segment_source(std::uint32_t segment) const { return source_of(segment_position_[segment]); }

Network::Source Network::vertex_source(std::uint32_t vertex) const { return source_of(vertex_position_[vertex]); }

bool Network::segment_is_ring(std::uint32_t segment) const {
  return part_is_ring_[source_of(segment_position_[segment]).part];
}

std::span<const std::uint32_t> Network::part(std::uint32_t p) const {
  return {chain_.data() + part_begin_[p], part_begin_[p + 1] - part_begin_[p]};
}

}  // namespace krepl
