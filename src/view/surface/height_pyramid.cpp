#include "view/surface/height_pyramid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace krepl::view {

namespace {

constexpr HeightPyramid::Sample nothing{std::numeric_limits<float>::quiet_NaN(), 0, 0};

/// Samples of one triangle: `put(column, row, height)` for each on or inside it. Places are in cells.
template <class Put>
void scan(const std::array<Point3, 3>& corner, std::int64_t side, Put&& put) {
  const auto [a, b, c] = corner;
  const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  if (!(area > 0)) return;
  const auto first = [](double v) { return std::int64_t(std::ceil(v)); };
  const auto last = [&](double v) { return std::min(side - 1, std::int64_t(std::floor(v))); };
  const double slope_x = ((b.z - a.z) * (c.y - a.y) - (c.z - a.z) * (b.y - a.y)) / area;
  const double slope_y = ((c.z - a.z) * (b.x - a.x) - (b.z - a.z) * (c.x - a.x)) / area;
  const std::int64_t top = last(std::max({a.y, b.y, c.y}));
  for (std::int64_t row = std::max<std::int64_t>(0, first(std::min({a.y, b.y, c.y}))); row <= top; ++row) {
    double left = std::min({a.x, b.x, c.x}), right = std::max({a.x, b.x, c.x});
    for (const auto& [p, q] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
      if (p.y == q.y) continue;
      const double x = p.x + (double(row) - p.y) / (q.y - p.y) * (q.x - p.x);
      if (q.y < p.y)
        left = std::max(left, x);  // a side that runs downwards has the triangle on its right
      else
        right = std::min(right, x);
    }
    for (std::int64_t column = std::max<std::int64_t>(0, first(left)); column <= last(right); ++column)
      put(column, row, a.z + slope_x * (double(column) - a.x) + slope_y * (double(row) - a.y));
  }
}

}  // namespace

HeightPyramid::HeightPyramid(const Shape& shape, Point low, double side, int levels) {
  levels_.resize(std::size_t(levels));
  const std::int64_t most = std::int64_t{cells} << (levels - 1);
  levels_.back() = {most + 1, std::vector<Sample>(std::size_t((most + 1) * (most + 1)), nothing)};
  draw(shape, low, side / double(most));
  for (std::size_t level = levels_.size() - 1; level-- > 0;) levels_[level] = coarser(levels_[level + 1]);
}

void HeightPyramid::draw(const Shape& shape, Point low, double cell) {
  Level& level = levels_.back();
  for (std::size_t f = 0; f < shape.faces.size(); ++f) {
    const Shape::FaceKind kind = shape.faces[f].kind;
    if (kind == Shape::FaceKind::wall) continue;
    const std::uint8_t cylinder = kind == Shape::FaceKind::cylinder ? 255 : 0,
                       sphere = kind == Shape::FaceKind::sphere ? 255 : 0;
    for (std::uint64_t t = shape.faces[f].first_triangle; t < shape.triangles_end(f); ++t) {
      std::array<Point3, 3> corner;
      for (std::size_t i = 0; i < 3; ++i) {
        const Point3 p = shape.vertices[shape.triangles[t][i]];
        corner[i] = {(p.x - low.x) / cell, (p.y - low.y) / cell, p.z};
      }
      scan(corner, level.side, [&](std::int64_t column, std::int64_t row, double height) {
        Sample& sample = level.samples[std::size_t(row * level.side + column)];
        if (!(sample.height >= float(height))) sample = {float(height), cylinder, sphere};
      });
    }
  }
}

HeightPyramid::Level HeightPyramid::coarser(const Level& fine) {
  Level level{fine.side / 2 + 1, {}};
  level.samples.assign(std::size_t(level.side * level.side), nothing);
  for (std::int64_t row = 0; row < level.side; ++row) {
    for (std::int64_t column = 0; column < level.side; ++column) {
      double weight = 0, cylinder = 0, sphere = 0;
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        for (std::int64_t dx = -1; dx <= 1; ++dx) {
          const std::int64_t x = 2 * column + dx, y = 2 * row + dy;
          if (x < 0 || y < 0 || x >= fine.side || y >= fine.side) continue;
          const Sample& s = fine.samples[std::size_t(y * fine.side + x)];
          if (std::isnan(s.height)) continue;
          const double w = (dx == 0 ? 2 : 1) * (dy == 0 ? 2 : 1);
          weight += w, cylinder += w * s.cylinder, sphere += w * s.sphere;
        }
      }
      if (weight == 0) continue;
      level.samples[std::size_t(row * level.side + column)] = {
          fine.samples[std::size_t(2 * row * fine.side + 2 * column)].height,
          std::uint8_t(std::lround(cylinder / weight)), std::uint8_t(std::lround(sphere / weight))};
    }
  }
  return level;
}

HeightPyramid::Sample HeightPyramid::sample(int level, std::int64_t column, std::int64_t row) const {
  const Level& l = levels_[std::size_t(level)];
  if (column < 0 || row < 0 || column >= l.side || row >= l.side) return nothing;
  return l.samples[std::size_t(row * l.side + column)];
}

}  // namespace krepl::view
