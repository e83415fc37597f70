// Terrains from triangles. Vertices are numbered along a Hilbert curve, edges and triangles by their sorted vertices:
// nothing depends on the order or orientation in which the triangles were given.
#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "kernel/hilbert.hpp"
#include "kernel/orientation.hpp"
#include "kernel/parallel.hpp"
#include "kernel/radix_sort.hpp"
#include "krepl/terrain.hpp"
#include "model/exact_origin.hpp"

namespace krepl {
namespace {

using Index = Terrain::Index;

constexpr std::size_t most_triangles = std::size_t{1} << 29;  // seven features each must fit into 32 bits
constexpr std::size_t block_size = std::size_t{1} << 14;
constexpr double infinity = std::numeric_limits<double>::infinity();

Error cancelled() { return {ErrorCode::cancelled, "cancelled", "", ""}; }

struct SpaceBox {
  Point3 low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
  void add(Point3 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  double largest() const {
    return std::max(
        {std::abs(low.x), std::abs(low.y), std::abs(low.z), std::abs(high.x), std::abs(high.y), std::abs(high.z)});
  }
};

bool finite(Point3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// Of the extent: vertices this close are one. Far below the accuracy of any result, and above what a rotation or a projection
/// leaves between the two ends of a seam of a part.
constexpr double weld_distance = 0x1p-42;

/// Places that are told apart, found again by a grid of cells in space.
class Places {
 public:
  Places(double distance, std::size_t most) : distance_(distance), cell_(4 * distance) { cells_.reserve(most); }

  /// Number of the first place within the distance of p; p becomes a new one if there is none.
  Index number(Point3 p, std::vector<Point3>& places) {
    const auto range = [&](double x) { return std::array<std::int64_t, 2>{index(x - distance_), index(x + distance_)}; };
    const auto x = range(p.x), y = range(p.y), z = range(p.z);
    for (std::int64_t i = x[0]; i <= x[1]; ++i) {
      for (std::int64_t j = y[0]; j <= y[1]; ++j) {
        for (std::int64_t k = z[0]; k <= z[1]; ++k) {
          const auto [first, last] = cells_.equal_range(key(i, j, k));
          for (auto it = first; it != last; ++it) {
            const Point3 q = places[it->second];
            if (std::max({std::fabs(q.x - p.x), std::fabs(q.y - p.y), std::fabs(q.z - p.z)}) <= distance_) return it->second;
          }
        }
      }
    }
    cells_.emplace(key(index(p.x), index(p.y), index(p.z)), Index(places.size()));
    places.push_back(p);
    return Index(places.size() - 1);
  }

 private:
  std::int64_t index(double x) const { return std::int64_t(std::floor(x / cell_)); }
  static std::uint64_t key(std::int64_t i, std::int64_t j, std::int64_t k) {
    std::uint64_t h = 0;
    for (const std::int64_t part : {i, j, k}) h = (h ^ std::uint64_t(part)) * 0x9e3779b97f4a7c15u ^ (h >> 29);
    return h;
  }
  double distance_, cell_;
  std::unordered_multimap<std::uint64_t, Index> cells_;
};

/// Begins of compressed rows from counts that stand one place further on.
void add_up(std::vector<Index>& begin) {
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
}

}  // namespace

class MeshBuilder {
 public:
  using Triangle = Terrain::Triangle;

  MeshBuilder(std::vector<Point3> points, std::vector<std::array<Index, 3>> corners, const Context& context)
      : points_(std::move(points)), corners_(std::move(corners)) {
    context_.threads = context.threads;
    context_.cancel = context.cancel;
    t_.report_.triangles = corners_.size();
  }

  Result<Terrain> build() {
    if (Status checked = check(); !checked) return checked.error();
    bool (MeshBuilder::*const steps[])() = {&MeshBuilder::weld,           &MeshBuilder::orient,
                                            &MeshBuilder::sort_triangles, &MeshBuilder::drop_unused,
                                            &MeshBuilder::number_edges,   &MeshBuilder::index_vertices,
                                            &MeshBuilder::plant_tree};
    for (const auto step : steps)
      if (!(this->*step)() || context_.cancelled()) return cancelled();
    if (t_.triangle_.empty()) {
      return Error{ErrorCode::input, "no triangle is left: all " + std::to_string(corners_.size()) + " have no area",
                   "", ""};
    }
    return std::move(t_);
  }

 private:
  Status check();
  bool weld();
  bool orient();
  bool sort_triangles();
  bool drop_unused();
  bool number_edges();
  bool index_vertices();
  bool plant_tree();

  std::vector<Point3> points_;                 // as given, then relative to the origin
  std::vector<std::array<Index, 3>> corners_;  // as given, then by number of welded vertex
  Context context_;
  SpaceBox box_;
  std::vector<bool> used_;
  Terrain t_;
};

Status MeshBuilder::check() {
  if (corners_.empty()) return Error{ErrorCode::input, "there is no triangle", "", ""};
  if (corners_.size() > most_triangles || points_.size() > std::numeric_limits<Index>::max()) {
    return Error{ErrorCode::input, "there are more than 2^29 triangles", "", "split the input"};
  }
  used_.assign(points_.size(), false);
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    for (const Index v : corners_[i]) {
      if (v >= points_.size()) {
        return Error{ErrorCode::input, "vertex " + std::to_string(v) + " does not exist",
                     "triangle " + std::to_string(i),
                     "there are " + std::to_string(points_.size()) + " vertices, counted from 0"};
      }
      if (!finite(points_[v])) {
        return Error{ErrorCode::input, "a coordinate is NaN or infinite",
                     "triangle " + std::to_string(i) + ", vertex " + std::to_string(v),
                     "repair or remove the triangle"};
      }
      used_[v] = true;
      box_.add(points_[v]);
    }
  }
  if (!std::isfinite(2 * box_.largest()))
    return Error{ErrorCode::input, "the coordinates are too large for double precision", "", "scale the input down"};
  t_.origin_ = {exact_origin(box_.low.x, box_.high.x), exact_origin(box_.low.y, box_.high.y),
                exact_origin(box_.low.z, box_.high.z)};
  return std::monostate{};
}

/// Numbers the places where vertices stand along the Hilbert curve, and names the corners by them. Which of several
/// close points stands for them does not depend on the order in which they were given.
bool MeshBuilder::weld() {
  const double width = std::max(box_.high.x - box_.low.x, box_.high.y - box_.low.y);
  const double scale = width > 0 && std::isfinite(65535.0 / width) ? 65535.0 / width : 0.0;
  const auto cell = [&](double d) { return std::uint32_t(std::clamp(d * scale, 0.0, 65535.0)); };
  std::vector<std::uint64_t> order;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!used_[i]) continue;
    Point3& p = points_[i];
    const std::uint32_t key = kernel::HilbertCurve::index(cell(p.x - box_.low.x), cell(p.y - box_.low.y));
    order.push_back(std::uint64_t{key} << 32 | i);
    // Adding 0 makes -0 to 0, so that equal places have equal bits.
    p = {p.x - t_.origin_.x + 0.0, p.y - t_.origin_.y + 0.0, p.z - t_.origin_.z + 0.0};
  }
  kernel::radix_sort(order, 32, context_);
  const auto point = [&](std::uint64_t entry) { return points_[std::uint32_t(entry)]; };
  const auto before = [&](std::uint64_t i, std::uint64_t j) {
    const Point3 p = point(i), q = point(j);
    return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
  };
  std::vector<Index> number(points_.size());
  const double extent = std::max({width, box_.high.z - box_.low.z, std::numeric_limits<double>::min()});
  Places places(weld_distance * extent, order.size());
  for (auto first = order.begin(); first != order.end();) {
    const auto last = std::find_if(first, order.end(), [&](std::uint64_t e) { return e >> 32 != *first >> 32; });
    std::sort(first, last, before);
    for (; first != last; ++first) {
      number[std::uint32_t(*first)] = places.number(point(*first), t_.vertex_);
    }
  }
  t_.report_.welded_vertices = order.size() - t_.vertex_.size();
  for (auto& corners : corners_)
    for (Index& v : corners) v = number[v];
  points_ = {};
  return true;
}

/// Sorts the corners of each triangle, drops what has no area, and turns the others counter-clockwise.
bool MeshBuilder::orient() {
  t_.triangle_.resize(corners_.size());
  const bool done =
      kernel::parallel_blocks(context_, corners_.size(), block_size, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
          std::array<Index, 3> v = corners_[i];
          std::sort(v.begin(), v.end());
          const Point3 a = t_.vertex_[v[0]], b = t_.vertex_[v[1]], c = t_.vertex_[v[2]];
          const int turn = kernel::orientation({a.x, a.y}, {b.x, b.y}, {c.x, c.y});
          if (turn < 0) std::swap(v[1], v[2]);
          if (turn == 0 && kernel::collinear(a, b, c)) v = {Terrain::none, Terrain::none, Terrain::none};
          t_.triangle_[i] = {v, {}, turn == 0};
        }
      });
  const auto kept = std::remove_if(t_.triangle_.begin(), t_.triangle_.end(),
                                   [](const Triangle& t) { return t.vertex[0] == Terrain::none; });
  t_.report_.zero_area_triangles = std::size_t(t_.triangle_.end() - kept);
  t_.triangle_.erase(kept, t_.triangle_.end());
  return done;
}

/// By sorted corners: a counting sort by the lowest one, then comparisons in what are mostly handfuls.
bool MeshBuilder::sort_triangles() {
  std::vector<Index> begin(t_.vertex_.size() + 1, 0);
  for (const Triangle& t : t_.triangle_) ++begin[t.vertex[0] + 1];
  add_up(begin);
  std::vector<Triangle> sorted(t_.triangle_.size());
  for (const Triangle& t : t_.triangle_) sorted[begin[t.vertex[0]]++] = t;
  const auto key = [](const Triangle& t) {
    const auto [low, high] = std::minmax(t.vertex[1], t.vertex[2]);
    return std::uint64_t{low} << 32 | high;
  };
  std::size_t first = 0;
  for (std::size_t v = 0; v < t_.vertex_.size(); first = begin[v++]) {  // begin[v] has moved on to the row's end
    std::sort(sorted.begin() + std::ptrdiff_t(first), sorted.begin() + std::ptrdiff_t(begin[v]),
              [&](const Triangle& s, const Triangle& t) { return key(s) < key(t); });
  }
  const auto kept = std::unique(sorted.begin(), sorted.end(), [&](const Triangle& s, const Triangle& t) {
    return s.vertex[0] == t.vertex[0] && key(s) == key(t);
  });
  t_.report_.repeated_triangles = std::size_t(sorted.end() - kept);
  sorted.erase(kept, sorted.end());
  sorted.shrink_to_fit();
  t_.triangle_ = std::move(sorted);
  t_.triangle_count_ = t_.triangle_.size();
  return true;
}

/// Vertices that only dropped triangles had, and the bounding box of the others.
bool MeshBuilder::drop_unused() {
  std::vector<Index> number(t_.vertex_.size(), 0);
  for (const Triangle& t : t_.triangle_)
    for (const Index v : t.vertex) number[v] = 1;
  Index kept = 0;
  SpaceBox box;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == 0) continue;
    box.add(t_.vertex_[v]);
    number[v] = kept;
    t_.vertex_[kept++] = t_.vertex_[v];
  }
  t_.vertex_.resize(kept);
  t_.vertex_.shrink_to_fit();
  for (Triangle& t : t_.triangle_) {
    for (Index& v : t.vertex) v = number[v];
    t_.report_.vertical_triangles += t.vertical;
  }
  t_.lowest_ = box.low, t_.highest_ = box.high;
  return true;
}

bool MeshBuilder::number_edges() {
  struct Side {
    Index other;  // its higher vertex
    Index slot;   // 3 * triangle + side
  };
  const auto for_each_side = [&](auto&& visit) {
    for (std::size_t t = 0; t < t_.triangle_.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i) {
        const auto [low, high] = std::minmax(t_.triangle_[t].vertex[i], t_.triangle_[t].vertex[(i + 1) % 3]);
        visit(low, Side{high, Index(3 * t + i)});
      }
  };
  std::vector<Index> begin(t_.vertex_.size() + 1, 0);
  for_each_side([&](Index low, Side) { ++begin[low + 1]; });
  add_up(begin);
  std::vector<Side> sides(3 * t_.triangle_.size());
  for_each_side([&](Index low, Side side) { sides[begin[low]++] = side; });
  std::size_t first = 0;
  for (std::size_t v = 0; v < t_.vertex_.size(); ++v) {
    const std::size_t last = begin[v];  // has moved on to the row's end
    std::sort(sides.begin() + std::ptrdiff_t(first), sides.begin() + std::ptrdiff_t(last),
              [](const Side& s, const Side& t) { return s.other != t.other ? s.other < t.other : s.slot < t.slot; });
    while (first < last) {
      const std::size_t start = first;
      for (; first < last && sides[first].other == sides[start].other; ++first)
        t_.triangle_[sides[first].slot / 3].edge[sides[first].slot % 3] = Index(t_.edge_.size());
      t_.edge_.push_back({Index(v), sides[start].other});
      t_.report_.border_edges += first - start == 1;
      t_.report_.non_manifold_edges += first - start > 2;
    }
  }
  t_.edge_.shrink_to_fit();
  return true;
}

bool MeshBuilder::index_vertices() {
  auto& begin = t_.vertex_triangle_begin_;
  begin.assign(t_.vertex_.size() + 2, 0);  // one more, because filling moves each begin on to its row's end
  for (const Triangle& t : t_.triangle_)
    for (const Index v : t.vertex) ++begin[v + 2];
  add_up(begin);
  t_.vertex_triangle_.resize(3 * t_.triangle_.size());
  for (std::size_t t = 0; t < t_.triangle_.size(); ++t)
    for (const Index v : t_.triangle_[t].vertex) t_.vertex_triangle_[begin[v + 1]++] = Index(t);
  begin.pop_back();
  return true;
}

bool MeshBuilder::plant_tree() {
  using Box = Terrain::Box;
  const auto groups = [](std::size_t n) { return (n + Terrain::tree_arity - 1) / Terrain::tree_arity; };
  const auto join = [](Box& box, const Box& other) {
    box = {std::min(box.min_x, other.min_x), std::min(box.min_y, other.min_y), std::max(box.max_x, other.max_x),
           std::max(box.max_y, other.max_y)};
  };
  constexpr Box empty{infinity, infinity, -infinity, -infinity};
  std::vector<Box> level(groups(t_.triangle_.size()), empty);
  for (std::size_t t = 0; t < t_.triangle_.size(); ++t)
    for (const Index v : t_.triangle_[t].vertex) {
      const Point3 p = t_.vertex_[v];
      join(level[t / Terrain::tree_arity], {p.x, p.y, p.x, p.y});
    }
  if (level.empty()) return true;
  while (level.size() > 1) {
    std::vector<Box> above(groups(level.size()), empty);
    for (std::size_t i = 0; i < level.size(); ++i) join(above[i / Terrain::tree_arity], level[i]);
    t_.tree_.push_back(std::move(level));
    level = std::move(above);
  }
  t_.tree_.push_back(std::move(level));
  return true;
}

Result<Terrain> Terrain::from_triangles(std::vector<Point3> vertices, std::vector<std::array<Index, 3>> triangles,
                                        const Context& context) {
  return MeshBuilder(std::move(vertices), std::move(triangles), context).build();
}

}  // namespace krepl
