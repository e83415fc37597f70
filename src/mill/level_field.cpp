#include "mill/level_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/vectors.hpp"

namespace krepl::mill {

using namespace vectors;

namespace {

constexpr int halvings = 6;
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Side {
  Point from, to;
};

double distance_from(Point p, const Side& s) {
  const Point way = s.to - s.from;
  const double squared = dot(way, way), t = squared > 0 ? std::clamp(dot(p - s.from, way) / squared, 0.0, 1.0) : 0;
  return length(p - (s.from + t * way));
}

}  // namespace

bool LevelField::build(const LiftedCutter& cutter, const PlaneRaster& raster, Point stock_low, Point stock_high,
                       const Context& context) {
  cutter_ = &cutter, raster_ = raster, low_ = stock_low, high_ = stock_high;
  height_.resize(raster.size());
  const std::size_t band = std::max<std::size_t>(1, 1000000 / raster.columns);
  std::vector<DropCutter::Contact> contacts;
  for (std::size_t row = 0; row < raster.rows; row += band) {
    const std::size_t count = std::min(band, raster.rows - row);
    contacts.assign(count * raster.columns, {});
    const DropCutter::Raster rows{raster.place(row * raster.columns), raster.step, raster.step, raster.columns, count};
    if (!cutter.drop.at(rows, contacts, context)) return false;
    for (std::size_t k = 0; k < contacts.size(); ++k)
      height_[row * raster.columns + k] = contacts[k].touches() ? contacts[k].height + cutter.lift : -infinity;
  }
  return true;
}

void LevelField::lay(double level) {
  std::vector<char> is_free(raster_.size());
  bool all = true;
  for (std::size_t v = 0; v < is_free.size(); ++v) is_free[v] = height_[v] <= level, all = all && is_free[v];
  distance_.assign(raster_.size(), infinity);
  if (all) {
    // Along the sides of the rectangle, from outside inwards.
    const Point middle = 0.5 * (low_ + high_), half = 0.5 * (high_ - low_);
    const double inside = std::min(half.x, half.y);
    for (std::size_t v = 0; v < distance_.size(); ++v) {
      const Point p = raster_.place(v) - middle;
      distance_[v] = inside + std::max(std::abs(p.x) - half.x, std::abs(p.y) - half.y);
    }
  } else {
    spread(raster_contours(raster_, is_free, [&](std::size_t free, std::size_t other) {
      Point inside = raster_.place(free), outside = raster_.place(other);
      for (int k = 0; k < halvings; ++k) {
        const Point middle = 0.5 * (inside + outside);
        (cutter_->height(middle) <= level ? inside : outside) = middle;
      }
      return inside;
    }));
    for (std::size_t v = 0; v < distance_.size(); ++v)
      if (!is_free[v]) distance_[v] = -distance_[v];
  }
  largest_ = 0;
  for (const double d : distance_)
    if (std::isfinite(d)) largest_ = std::max(largest_, d);
}

/// The nearest side of the borders, from place to place over the raster, to and fro.
void LevelField::spread(const std::vector<RasterContour>& borders) {
  std::vector<Side> sides;
  std::vector<std::uint32_t> nearest(raster_.size(), ~std::uint32_t{0});
  const auto attempt = [&](std::size_t v, std::uint32_t side) {
    if (side == ~std::uint32_t{0} || nearest[v] == side) return;
    const double d = distance_from(raster_.place(v), sides[side]);
    if (d < distance_[v]) distance_[v] = d, nearest[v] = side;
  };
  const auto columns = std::int64_t(raster_.columns), rows = std::int64_t(raster_.rows);
  for (const RasterContour& border : borders)
    for (std::size_t k = 0; k + 1 < border.points.size(); ++k) {
      sides.push_back({border.points[k], border.points[k + 1]});
      const Point middle = 0.5 * (border.points[k] + border.points[k + 1]);
      const auto c = std::int64_t((middle.x - raster_.first.x) / raster_.step),
                 r = std::int64_t((middle.y - raster_.first.y) / raster_.step);
      for (std::int64_t y = std::max<std::int64_t>(0, r - 1); y <= std::min(rows - 1, r + 2); ++y)
        for (std::int64_t x = std::max<std::int64_t>(0, c - 1); x <= std::min(columns - 1, c + 2); ++x)
          attempt(std::size_t(y * columns + x), std::uint32_t(sides.size() - 1));
    }
  for (int round = 0; round < 4; ++round) {
    const bool forwards = round % 2 == 0;
    for (std::int64_t k = 0; k < columns * rows; ++k) {
      const std::int64_t v = forwards ? k : columns * rows - 1 - k, c = v % columns, r = v / columns;
      for (std::int64_t y = std::max<std::int64_t>(0, r - 1); y <= std::min(rows - 1, r + 1); ++y)
        for (std::int64_t x = std::max<std::int64_t>(0, c - 1); x <= std::min(columns - 1, c + 1); ++x)
          attempt(std::size_t(v), nearest[std::size_t(y * columns + x)]);
    }
  }
}

}  // namespace krepl::mill
