#include "mill/interest.hpp"

#include <algorithm>
#include <cmath>

#include "mill/steepness.hpp"

namespace krepl::mill {

Interest::Interest(const DropCutter& cutter, const PassLimits& limits, double cell) : cell_(cell) {
  if (limits.boundary.is_everywhere() && limits.shallow <= 0) return;
  const Point3 low = cutter.terrain().lowest(), high = cutter.terrain().highest();
  first_ = {low.x - cutter.radius(), low.y - cutter.radius()};
  columns_ = std::size_t(std::ceil((high.x - low.x + 2 * cutter.radius()) / cell)) + 1;
  rows_ = std::size_t(std::ceil((high.y - low.y + 2 * cutter.radius()) / cell)) + 1;
  cells_.assign(columns_ * rows_, limits.boundary.is_everywhere());
  if (!limits.boundary.is_everywhere()) mark_inside(limits.boundary);
  if (limits.shallow <= 0) return;
  Steepness steepness(cutter);
  for (std::size_t k = 0; k < cells_.size(); ++k) {
    const Point middle{first_.x + (double(k % columns_) + 0.5) * cell, first_.y + (double(k / columns_) + 0.5) * cell};
    if (cells_[k] && !(steepness.at(middle) < limits.shallow)) cells_[k] = 0;
  }
}

/// Cells of which the middle is inside, and those of all cells beside it: passes end before the boundary.
void Interest::mark_inside(const Boundary& boundary) {
  std::vector<char> inside(cells_.size(), 0);
  for (std::size_t r = 0; r < rows_; ++r) {
    const Line line{{first_.x, first_.y + (double(r) + 0.5) * cell_}, {1, 0}};
    for (const Interval& i : boundary.inside(line, 0, double(columns_) * cell_))
      for (double c = std::ceil(i.low / cell_ - 0.5); (c + 0.5) * cell_ <= i.high; ++c)
        if (c >= 0 && c < double(columns_)) inside[r * columns_ + std::size_t(c)] = 1;
  }
  for (std::size_t r = 1; r + 1 < rows_; ++r)
    for (std::size_t c = 1; c + 1 < columns_; ++c) {
      bool all = true;
      for (std::size_t y = r - 1; y <= r + 1; ++y)
        for (std::size_t x = c - 1; x <= c + 1; ++x) all = all && inside[y * columns_ + x];
      cells_[r * columns_ + c] = all;
    }
}

bool Interest::has(Point p, double within) const {
  const auto cell = [&](double x, double first, std::size_t count) {
    return std::size_t(std::clamp(std::floor((x - first) / cell_), 0.0, double(count - 1)));
  };
  for (std::size_t r = cell(p.y - within, first_.y, rows_), last = cell(p.y + within, first_.y, rows_); r <= last; ++r)
    for (std::size_t c = cell(p.x - within, first_.x, columns_), end = cell(p.x + within, first_.x, columns_); c <= end;
         ++c)
      if (cells_[r * columns_ + c]) return true;
  return false;
}

}  // namespace krepl::mill
