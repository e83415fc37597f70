#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "verify/plane.hpp"

namespace krepl::verify {

/// Horizontal bands of equal height; each names the items whose range of y reaches into it.
class Bands {
 public:
  Bands() = default;
  /// ranges[i] = least and largest y of item i.
  explicit Bands(const std::vector<std::pair<Real, Real>>& ranges) {
    if (ranges.empty()) return;
    low_ = HUGE_VALL;
    Real high = -HUGE_VALL, heights = 0;
    for (const auto& [y0, y1] : ranges) low_ = std::min(low_, y0), high = std::max(high, y1), heights += y1 - y0;
    // At most about five entries an item.
    const Real count = Real(ranges.size());
    height_ = std::max((high - low_) / count, heights / (4 * count));
    const std::size_t bands = height_ > 0 ? std::size_t((high - low_) / height_) + 1 : 1;
    begin_.assign(bands + 1, 0);
    for (const auto& r : ranges)
      for (std::size_t b = band(r.first); b <= band(r.second); ++b) ++begin_[b + 1];
    for (std::size_t b = 0; b < bands; ++b) begin_[b + 1] += begin_[b];
    items_.resize(begin_.back());
    std::vector<std::size_t> at(begin_.begin(), begin_.end() - 1);
    for (std::size_t i = 0; i < ranges.size(); ++i)
      for (std::size_t b = band(ranges[i].first); b <= band(ranges[i].second); ++b) items_[at[b]++] = std::uint32_t(i);
  }

  /// Items that may reach height y.
  std::span<const std::uint32_t> at(Real y) const {
    if (begin_.size() < 2 || y < low_) return {};
    const std::size_t b = band(y);
    return {items_.data() + begin_[b], begin_[b + 1] - begin_[b]};
  }

 private:
  std::size_t band(Real y) const {
    if (!(height_ > 0)) return 0;
    return std::min(std::size_t((y - low_) / height_), begin_.size() - 2);
  }
  Real low_ = 0, height_ = 0;
  std::vector<std::size_t> begin_;
  std::vector<std::uint32_t> items_;
};

}  // namespace krepl::verify
