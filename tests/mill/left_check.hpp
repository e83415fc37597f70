#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "krepl/drop_cutter.hpp"
#include "krepl/mill.hpp"
#include "krepl/simulation.hpp"

namespace krepl::test {

/// Places of the plane at equal distances, in the part's own coordinates.
struct Dexels {
  Point first;
  double cell = 0;
  std::size_t columns = 0, rows = 0;
};

/// What is above all places nearer than `core` to places where a ball of radius `radius` rests on a part, by brute force: relative to
/// the part's origin. The ball is dropped on a raster half as wide as the dexels, so heights are too high if anything, and each is
/// that of a place that is so near to a true one.
inline std::vector<double> eroded(const std::shared_ptr<const Terrain>& part, double radius, double core, const Dexels& d) {
  std::vector<double> heights(d.columns * d.rows, std::numeric_limits<double>::infinity());
  const auto drop = DropCutter::build(part, radius);
  if (!drop) return heights;
  const Point3 origin = part->origin();
  const double fine = d.cell / 2;
  const auto reach = std::int64_t(std::ceil(core / fine));
  DropCutter::Raster raster{{d.first.x - origin.x - double(reach) * fine, d.first.y - origin.y - double(reach) * fine}, fine, fine,
                            2 * d.columns + 2 * std::size_t(reach), 2 * d.rows + 2 * std::size_t(reach)};
  std::vector<DropCutter::Contact> rest(raster.columns * raster.rows);
  if (!drop->at(raster, rest)) return heights;
  for (std::int64_t y = -reach; y <= reach; ++y)
    for (std::int64_t x = -reach; x <= reach; ++x) {
      const double under = core * core - fine * fine * double(x * x + y * y);
      if (under < 0) continue;
      const double down = std::sqrt(under);
      for (std::size_t r = 0; r < d.rows; ++r)
        for (std::size_t c = 0; c < d.columns; ++c) {
          const DropCutter::Contact& contact =
              rest[std::size_t(std::int64_t(2 * r) + reach + y) * raster.columns + std::size_t(std::int64_t(2 * c) + reach + x)];
          double& height = heights[r * d.columns + c];
          if (contact.touches()) height = std::min(height, contact.height - down);
        }
    }
  return heights;
}

/// How far, at worst, a path's material stands above what is nowhere farther than `scallop` from what its ball can reach.
struct LeftCheck {
  double worst = -1e300;  ///< vertically, at a dexel; not above zero if the scallop is kept
  Point3 at{};
  std::size_t dexels = 0, over = 0;
};

/// The material is that of a simulation, which knows nothing of proofs. Whatever is nearer than r - h to a free place of the ball's
/// centre is farther than h from all that the ball of radius r cannot reach, and has to be gone.
/// `before`: heights by dexel that the material has at most when the path begins; may be empty.
inline LeftCheck check_left(const std::shared_ptr<const Terrain>& part, const ToolPath& path, double radius, double scallop,
                            double cell, const std::vector<double>& before = {}, double slack = 0) {
  LeftCheck check;
  StockOptions stock;
  stock.cell = cell, stock.top = part->highest().z + part->origin().z + 2 * radius;
  const auto cutter = Cutter::ball(2 * radius);
  if (!cutter) return check;
  const auto left = Simulation::run(path, *part, *cutter, stock);
  if (!left) return check;
  const Dexels dexels{left->place(0, 0), cell, left->columns(), left->rows()};
  const std::vector<double> limit = eroded(part, radius, radius - scallop, dexels);
  for (std::size_t d = 0; d < limit.size(); ++d) {
    if (!std::isfinite(left->part()[d]) || !std::isfinite(limit[d])) continue;
    double material = left->left()[d] - part->origin().z;
    if (!before.empty()) material = std::min(material, before[d]);
    const double above = material - limit[d] - slack;
    ++check.dexels, check.over += above > 1e-9 * part->extent();
    const Point p = left->place(d % left->columns(), d / left->columns());
    if (above > check.worst) check.worst = above, check.at = {p.x, p.y, left->left()[d]};
  }
  return check;
}

}  // namespace krepl::test
