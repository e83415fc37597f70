#include "mill/grid_lines.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/vectors.hpp"

namespace krepl::mill {

using namespace vectors;

namespace {

using Index = SurfaceGrid::Index;

/// Where a level crosses a side of the raster: towards +x, +y or both from a place.
struct Crossing {
  std::uint32_t level;
  std::uint64_t side;  // 3 place + kind
  bool operator==(const Crossing&) const = default;
  bool operator<(const Crossing& c) const { return level != c.level ? level < c.level : side < c.side; }
};

struct Segment {
  Crossing end[2];
};

class LineMaker {
 public:
  LineMaker(const SurfaceGrid& grid, const std::vector<double>& field, const GridLineOptions& options)
      : grid_(grid), field_(field), o_(options) {}

  std::vector<SpaceLine> run() {
    const Index across = Index(grid_.columns());
    for (Index r = 0; r + 1 < grid_.rows(); ++r)
      for (Index c = 0; c + 1 < across; ++c) {
        const Index v = r * across + c;
        if (o_.cells != nullptr && !(*o_.cells)[v]) continue;
        cross(v, v + 1, v + across + 1);
        cross(v, v + across + 1, v + across);
      }
    return join();
  }

 private:
  std::uint64_t side(Index a, Index b) const {
    const Index low = std::min(a, b), high = std::max(a, b);
    return 3 * std::uint64_t(low) + (high == low + 1 ? 0u : high == low + grid_.columns() ? 1u : 2u);
  }
  double value(std::uint32_t level) const { return o_.first + double(level) * o_.step; }

  void cross(Index a, Index b, Index c) {
    const Index corner[3] = {a, b, c};
    double low = field_[a], high = low;
    for (const Index v : corner) low = std::min(low, field_[v]), high = std::max(high, field_[v]);
    if (!std::isfinite(high)) return;
    const double from = std::max(0.0, std::ceil((low - o_.first) / o_.step) - 1);
    for (double k = from; value(std::uint32_t(k)) <= high; ++k) {
      const auto level = std::uint32_t(k);
      Segment s;
      int ends = 0;
      for (int i = 0; i < 3; ++i) {
        const Index p = corner[i], q = corner[(i + 1) % 3];
        if ((field_[p] >= value(level)) != (field_[q] >= value(level)) && ends < 2) s.end[ends++] = {level, side(p, q)};
      }
      if (ends == 2) segments_.push_back(s);
    }
  }

  /// Ends at the same crossing belong together; there are two at most.
  std::vector<SpaceLine> join() {
    std::vector<std::uint32_t> order(2 * segments_.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = std::uint32_t(k);
    const auto at = [&](std::uint32_t e) -> const Crossing& { return segments_[e / 2].end[e % 2]; };
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return at(a) == at(b) ? a < b : at(a) < at(b); });
    mate_.assign(order.size(), SurfaceGrid::none);
    for (std::size_t k = 0; k + 1 < order.size(); ++k)
      if (at(order[k]) == at(order[k + 1])) mate_[order[k]] = order[k + 1], mate_[order[k + 1]] = order[k];
    used_.assign(segments_.size(), 0);
    std::vector<SpaceLine> lines;
    for (const std::uint32_t e : order)  // level by level
      if (mate_[e] == SurfaceGrid::none && !used_[e / 2]) lines.push_back(walk(e));
    for (const std::uint32_t e : order)  // closed ones
      if (!used_[e / 2]) lines.push_back(walk(e));
    return lines;
  }

  SpaceLine walk(std::uint32_t e) {
    SpaceLine line{point(segments_[e / 2].end[e % 2])};
    while (e != SurfaceGrid::none && !used_[e / 2]) {
      used_[e / 2] = 1;
      line.push_back(point(segments_[e / 2].end[1 - e % 2]));
      e = mate_[e ^ 1u];
    }
    return line;
  }

  Point3 point(const Crossing& c) const {
    const Index a = Index(c.side / 3), across = Index(grid_.columns());
    const Index b = a + (c.side % 3 == 0 ? 1 : c.side % 3 == 1 ? across : across + 1);
    const Point3 p = grid_.centre(a), q = grid_.centre(b);
    return p + std::clamp((value(c.level) - field_[a]) / (field_[b] - field_[a]), 0.0, 1.0) * (q - p);
  }

  const SurfaceGrid& grid_;
  const std::vector<double>& field_;
  const GridLineOptions& o_;
  std::vector<Segment> segments_;
  std::vector<std::uint32_t> mate_;
  std::vector<char> used_;
};

}  // namespace

std::vector<SpaceLine> grid_lines(const SurfaceGrid& grid, const std::vector<double>& field, const GridLineOptions& options) {
  return LineMaker(grid, field, options).run();
}

}  // namespace krepl::mill
