#include "view/surface/tile_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace krepl::view {

namespace {

constexpr int deepest = 16;
/// 32 cells times 2^7: 4097 samples a side.
constexpr int most_sampled_levels = 8;

std::uint64_t spread(std::uint32_t v) {
  std::uint64_t x = v;
  x = (x | x << 16) & 0x0000ffff0000ffffu;
  x = (x | x << 8) & 0x00ff00ff00ff00ffu;
  x = (x | x << 4) & 0x0f0f0f0f0f0f0f0fu;
  x = (x | x << 2) & 0x3333333333333333u;
  return (x | x << 1) & 0x5555555555555555u;
}

void grow(Point3& low, Point3& high, Point3 p) {
  low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
  high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
}

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

TileTree::TileTree(const Shape& shape) : shape_(shape) {
  measure();
  sort_faces();
  split();
  make_boxes();
  line_begin_.assign(shape.faces.size() + 1, 0);
  for (const Shape::Line& line : shape.lines) ++line_begin_[line.face + 1];
  std::partial_sum(line_begin_.begin(), line_begin_.end(), line_begin_.begin());
  line_.resize(shape.lines.size());
  std::vector<std::uint32_t> fill(line_begin_.begin(), line_begin_.end() - 1);
  for (std::uint32_t i = 0; i < shape.lines.size(); ++i) line_[fill[shape.lines[i].face]++] = i;
}

void TileTree::measure() {
  Point3 low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
  for (const auto& triangle : shape_.triangles)
    for (const Shape::Index v : triangle) grow(low, high, shape_.vertices[v]);
  side_ = std::max({high.x - low.x, high.y - low.y, std::numeric_limits<double>::min()});
  low_ = {low.x, low.y};
}

void TileTree::sort_faces() {
  std::vector<std::uint64_t> key(shape_.faces.size());
  for (std::size_t f = 0; f < key.size(); ++f) {
    Point3 low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
    for (std::uint64_t t = shape_.faces[f].first_triangle; t < shape_.triangles_end(f); ++t)
      for (const Shape::Index v : shape_.triangles[t]) grow(low, high, shape_.vertices[v]);
    const auto cell = [&](double middle, double least) {
      const double most = double((1u << deepest) - 1);
      const double place = (middle - least) / side_ * double(1u << deepest);
      return std::uint32_t(place > 0 ? std::min(place, most) : 0.0);  // a face without triangles goes to the first one
    };
    key[f] = spread(cell((low.x + high.x) / 2, low_.x)) | spread(cell((low.y + high.y) / 2, low_.y)) << 1;
  }
  order_.resize(key.size());
  std::iota(order_.begin(), order_.end(), 0u);
  std::stable_sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) { return key[a] < key[b]; });
  running_.assign(1, 0);
  for (const std::uint32_t f : order_) {
    place_.push_back(key[f]);
    running_.push_back(running_.back() + shape_.triangles_end(f) - shape_.faces[f].first_triangle);
  }
}

std::uint64_t TileTree::triangles_in(std::uint32_t first, std::uint32_t last) const {
  return running_[last] - running_[first];
}

void TileTree::split() {
  tiles_.push_back({0, 0, 0, 0, 0, 0, std::uint32_t(order_.size()), {}, {}});
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    const Tile tile = tiles_[i];
    if (triangles_in(tile.first, tile.last) <= most_triangles || tile.last - tile.first < 2) continue;
    tiles_[i].first_child = std::uint32_t(tiles_.size());
    const auto add = [&](int depth, std::int64_t column, std::int64_t row, std::uint32_t first, std::uint32_t last) {
      if (first < last) tiles_.push_back({depth, column, row, 0, 0, first, last, {}, {}});
    };
    if (tile.depth < deepest) {
      sampled_levels_ = std::min(most_sampled_levels, std::max(sampled_levels_, tile.depth + 1));
      const int shift = 2 * (deepest - tile.depth - 1);
      for (std::uint32_t quarter = 0, first = tile.first; quarter < 4; ++quarter) {
        const auto end = std::partition_point(place_.begin() + first, place_.begin() + tile.last,
                                              [&](std::uint64_t place) { return (place >> shift & 3) <= quarter; });
        const auto last = std::uint32_t(end - place_.begin());
        add(tile.depth + 1, 2 * tile.column + (quarter & 1), 2 * tile.row + (quarter >> 1), first, last);
        first = last;
      }
    } else {
      // All in one place: halves of the order.
      const std::uint32_t middle = tile.first + (tile.last - tile.first) / 2;
      add(tile.depth, tile.column, tile.row, tile.first, middle);
      add(tile.depth, tile.column, tile.row, middle, tile.last);
    }
    tiles_[i].children = std::uint32_t(tiles_.size()) - tiles_[i].first_child;
  }
}

void TileTree::make_boxes() {
  for (std::size_t i = tiles_.size(); i-- > 0;) {
    Tile& tile = tiles_[i];
    tile.low = {infinity, infinity, infinity}, tile.high = {-infinity, -infinity, -infinity};
    for (std::uint32_t c = 0; c < tile.children; ++c) {
      const Tile& child = tiles_[tile.first_child + c];
      grow(tile.low, tile.high, child.low);
      grow(tile.low, tile.high, child.high);
    }
    if (tile.children > 0) continue;
    for (std::uint32_t k = tile.first; k < tile.last; ++k)
      for (std::uint64_t t = shape_.faces[order_[k]].first_triangle; t < shape_.triangles_end(order_[k]); ++t)
        for (const Shape::Index v : shape_.triangles[t]) grow(tile.low, tile.high, shape_.vertices[v]);
    if (tile.low.x > tile.high.x) tile.low = tile.high = {low_.x, low_.y, 0};  // faces without triangles
  }
}

std::vector<std::uint32_t> TileTree::lines_of(const Tile& leaf) const {
  std::vector<std::uint32_t> lines;
  for (std::uint32_t k = leaf.first; k < leaf.last; ++k)
    lines.insert(lines.end(), line_.begin() + line_begin_[order_[k]], line_.begin() + line_begin_[order_[k] + 1]);
  return lines;
}

}  // namespace krepl::view
