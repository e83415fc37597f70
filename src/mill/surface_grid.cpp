#include "mill/surface_grid.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

#include "kernel/parallel.hpp"
#include "kernel/vectors.hpp"

namespace krepl::mill {

using namespace vectors;

namespace {

struct Extent {
  Point first;
  double columns, rows;
};

Extent extent_of(const DropCutter& cutter, double step) {
  const Point3 low = cutter.terrain().lowest(), high = cutter.terrain().highest();
  const double margin = cutter.radius() + step;
  return {{low.x - margin, low.y - margin},
          std::ceil((high.x - low.x + 2 * margin) / step) + 1,
          std::ceil((high.y - low.y + 2 * margin) / step) + 1};
}

constexpr int moves[16][2] = {{1, 0},  {-1, 0}, {0, 1},  {0, -1}, {1, 1},  {1, -1}, {-1, 1},  {-1, -1},
                              {2, 1},  {2, -1}, {-2, 1}, {-2, -1}, {1, 2}, {1, -2}, {-1, 2}, {-1, -2}};

}  // namespace

double SurfaceGrid::count(const DropCutter& cutter, double step) {
  const Extent e = extent_of(cutter, step);
  return e.columns * e.rows;
}

bool SurfaceGrid::build(const DropCutter& cutter, const Options& options, const Context& context) {
  o_ = options;
  const Extent e = extent_of(cutter, o_.step);
  first_ = e.first, columns_ = std::size_t(e.columns), rows_ = std::size_t(e.rows);
  height_.assign(size(), lowest), normal_.assign(3 * size(), 0.0f);
  // Bands of rows: contacts take more memory than what is kept of them.
  const std::size_t band = std::max<std::size_t>(1, 1000000 / columns_);
  std::vector<DropCutter::Contact> contacts;
  for (std::size_t row = 0; row < rows_; row += band) {
    const std::size_t count = std::min(band, rows_ - row);
    contacts.assign(count * columns_, {});
    const DropCutter::Raster raster{{first_.x, first_.y + double(row) * o_.step}, o_.step, o_.step, columns_, count};
    if (!cutter.at(raster, contacts, context)) return false;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      if (!contacts[k].touches()) continue;
      const std::size_t v = row * columns_ + k;
      height_[v] = contacts[k].height;
      const Point3 way = centre(Index(v)) - contacts[k].point;
      const Point3 n = (1 / std::max(length(way), 1e-300)) * way;
      normal_[3 * v] = float(n.x), normal_[3 * v + 1] = float(n.y), normal_[3 * v + 2] = float(n.z);
    }
  }
  return true;
}

Point3 SurfaceGrid::normal(Index v) const {
  const std::size_t k = 3 * std::size_t(v);
  return {normal_[k], normal_[k + 1], normal_[k + 2]};
}

SurfaceGrid::Index SurfaceGrid::cell_of(double x, double y) const {
  const double c = std::floor((x - first_.x) / o_.step), r = std::floor((y - first_.y) / o_.step);
  if (!(c >= 0 && r >= 0 && c < double(columns_ - 1) && r < double(rows_ - 1))) return none;
  return Index(r) * Index(columns_) + Index(c);
}

double SurfaceGrid::metric(Index v, Index w) const {
  const Point3 d = centre(w) - centre(v);
  const double squared = dot(d, d), most = 2 * o_.step;
  // Where the surface falls down a wall, its foot is the only place that is hollow. Convex edges gain nothing: passes on both sides
  // of them see each other's ground at an angle.
  const double bend = std::clamp(dot(d, normal(v) - normal(w)), 0.0, most);
  return std::sqrt(squared + (o_.radius - o_.height) * bend);
}

double SurfaceGrid::distance_to(Index v, Point3 p) const { return distance(centre(v), p); }

void SurfaceGrid::spread(std::vector<double>& distance) const {
  struct Entry {
    double distance;
    Index place;
    bool operator<(const Entry& e) const { return distance != e.distance ? distance > e.distance : place > e.place; }
  };
  std::priority_queue<Entry> queue;
  for (std::size_t v = 0; v < size(); ++v)
    if (std::isfinite(distance[v])) queue.push({distance[v], Index(v)});
  while (!queue.empty()) {
    const Entry at = queue.top();
    queue.pop();
    if (at.distance > distance[at.place]) continue;
    const auto c = std::int64_t(at.place % columns_), r = std::int64_t(at.place / columns_);
    for (const auto& move : moves) {
      const std::int64_t x = c + move[0], y = r + move[1];
      if (x < 0 || y < 0 || x >= std::int64_t(columns_) || y >= std::int64_t(rows_)) continue;
      const Index w = Index(y) * Index(columns_) + Index(x);
      if (!touches(w)) continue;
      const double d = at.distance + metric(at.place, w);
      if (d < distance[w]) distance[w] = d, queue.push({d, w});
    }
  }
}

}  // namespace krepl::mill
