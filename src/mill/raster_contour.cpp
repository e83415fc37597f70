#include "mill/raster_contour.hpp"

#include <algorithm>
#include <array>

namespace krepl::mill {
namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

}  // namespace

/// Marching squares: each cell joins the sides where its border, counter-clockwise, leaves what is high to those where
/// it came there.
std::vector<RasterContour> raster_contours(const PlaneRaster& raster, const std::vector<char>& is_high,
                                           const std::function<Point(std::size_t, std::size_t)>& crossing) {
  const std::size_t n = raster.columns;
  // Sides: 2 v from v to the right, 2 v + 1 upwards. What follows each, and whether something leads to it.
  std::vector<std::uint32_t> next(2 * raster.size(), none);
  std::vector<char> has_before(2 * raster.size(), 0);
  for (std::size_t r = 0; r + 1 < raster.rows; ++r)
    for (std::size_t c = 0; c + 1 < n; ++c) {
      const std::size_t v = r * n + c;
      const std::array<std::size_t, 4> corners{v, v + 1, v + n + 1, v + n};
      const std::array<std::size_t, 4> sides{2 * v, 2 * (v + 1) + 1, 2 * (v + n), 2 * v + 1};
      for (std::size_t k = 0; k < 4; ++k) {
        if (!is_high[corners[k]] || is_high[corners[(k + 1) % 4]]) continue;
        std::size_t m = k;
        while (is_high[corners[m]]) m = (m + 3) % 4;
        next[sides[k]] = std::uint32_t(sides[m]), has_before[sides[m]] = 1;
      }
    }
  const auto ends = [&](std::size_t side) {
    const std::size_t v = side / 2, w = v + (side % 2 == 0 ? 1 : n);
    return is_high[v] ? std::pair{v, w} : std::pair{w, v};
  };
  std::vector<RasterContour> found;
  const auto follow = [&](std::size_t first) {
    RasterContour contour;
    contour.high = ends(first).first;
    std::size_t side = first;
    do {
      const auto [high, low] = ends(side);
      contour.points.push_back(crossing(high, low));
      const std::uint32_t following = next[side];
      next[side] = none;
      if (following == none) break;
      side = following;
    } while (side != first);
    if (side == first && contour.points.size() > 1) contour.points.push_back(contour.points.front());
    if (contour.points.size() > 1) found.push_back(std::move(contour));
  };
  for (const bool open : {true, false})
    for (std::size_t side = 0; side < next.size(); ++side)
      if (next[side] != none && !(open && has_before[side])) follow(side);
  return found;
}

}  // namespace krepl::mill
