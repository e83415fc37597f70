#include "mill/rest_area.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/parallel.hpp"
#include "kernel/vectors.hpp"
#include "mill/on_surface.hpp"

namespace krepl::mill {

using namespace vectors;

namespace {

constexpr int most_rounds = 12;
constexpr double least_turn = 0.998;  // cosine of the angle of normals of neighbouring places that is looked into
constexpr double least_gain = 0.75;   // of a round: what remains of the distance too far

/// Whether a free place of the larger ball is within `radius` of x; looked for from c on, which is.
bool is_reached(const DropCutter& larger, const OnSurface& surface, Point3 x, Point3 c, double radius) {
  double excess = 1e300;
  for (int k = 0; k < most_rounds; ++k) {
    const DropCutter::Contact contact = larger.at({c.x, c.y});
    if (!contact.touches() || contact.height <= c.z) return true;
    if (distance({c.x, c.y, contact.height}, x) <= radius) return true;
    c = surface.put(c);
    const double away = distance(c, x);
    if (away <= radius) return true;
    if (away - radius > least_gain * excess) return false;
    excess = away - radius;
    c = x + (radius / away) * (c - x);
  }
  return false;
}

/// Where a ball is free over a raster, for all balls about places x at once.
class FreePlaces {
 public:
  bool build(const DropCutter& cutter, const SurfaceGrid& grid, double reach, const Context& context) {
    const double step = grid.step();
    margin_ = std::int64_t(std::ceil(reach / step)) + 1;
    columns_ = std::int64_t(grid.columns()) + 2 * margin_, rows_ = std::int64_t(grid.rows()) + 2 * margin_;
    const Point first = grid.place(0);
    first_ = {first.x - double(margin_) * step, first.y - double(margin_) * step}, step_ = step;
    height_.resize(std::size_t(columns_ * rows_));
    const std::int64_t band = std::max<std::int64_t>(1, 1000000 / columns_);
    std::vector<DropCutter::Contact> contacts;
    for (std::int64_t row = 0; row < rows_; row += band) {
      const std::int64_t count = std::min(band, rows_ - row);
      contacts.assign(std::size_t(count * columns_), {});
      const DropCutter::Raster raster{
          {first_.x, first_.y + double(row) * step}, step, step, std::size_t(columns_), std::size_t(count)};
      if (!cutter.at(raster, contacts, context)) return false;
      for (std::size_t k = 0; k < contacts.size(); ++k) height_[std::size_t(row * columns_) + k] = contacts[k].height;
    }
    return true;
  }

  /// The nearest free place over the raster within `reach` of x, or one that is within `enough`; its distance.
  double nearest(Point3 x, double reach, double enough, Point3& place) const {
    double least = reach;
    const auto c = std::int64_t(std::llround((x.x - first_.x) / step_)),
               r = std::int64_t(std::llround((x.y - first_.y) / step_));
    const auto far = std::int64_t(std::ceil(reach / step_));
    // Rows from the middle outwards: what is free and near is mostly close by.
    for (std::int64_t n = 0; n <= 2 * far; ++n) {
      const std::int64_t row = r + (n % 2 == 0 ? n / 2 : -(n + 1) / 2);
      const double dy = first_.y + double(row) * step_ - x.y, half = least * least - dy * dy;
      if (row < 0 || row >= rows_ || half < 0) continue;
      const auto wide = std::int64_t(std::sqrt(half) / step_) + 1;
      for (std::int64_t column = std::max<std::int64_t>(0, c - wide); column <= std::min(columns_ - 1, c + wide);
           ++column) {
        const double dx = first_.x + double(column) * step_ - x.x,
                     dz = std::max(0.0, height_[std::size_t(row * columns_ + column)] - x.z);
        const double squared = dx * dx + dy * dy + dz * dz;
        if (!(squared < least * least)) continue;
        least = std::sqrt(squared), place = {x.x + dx, x.y + dy, x.z + dz};
        if (least <= enough) return least;
      }
    }
    return least;
  }

 private:
  std::int64_t margin_ = 0, columns_ = 0, rows_ = 0;
  Point first_;
  double step_ = 0;
  std::vector<double> height_;
};

}  // namespace

bool find_rest(const SurfaceGrid& grid, const DropCutter& cutter, const RestOf& o, const Context& context,
               std::vector<char>& rest) {
  rest.assign(grid.size(), 0);
  const double radius = o.radius + o.allowance;
  const Result<DropCutter> larger = cutter.with_radius(radius);
  if (!larger) return false;
  // Any free place is near one of the raster over which a ball so much smaller is free as high.
  const double aside = std::min(grid.step() / std::sqrt(2.0) * 1.000001, radius / 2);
  const Result<DropCutter> smaller = cutter.with_radius(radius - aside);
  if (!smaller) return false;
  FreePlaces free, roughly_free;
  if (!free.build(*larger, grid, o.radius + 2 * aside, context) ||
      !roughly_free.build(*smaller, grid, o.radius + 2 * aside, context))
    return false;
  const double slack = o.threshold / 8;
  const OnSurface surface(*larger, slack, slack);
  const auto is_rest = [&](Point3 c, Point3 n) {
    const Point3 x = c - (cutter.radius() - o.allowance - o.threshold) * n;
    const double enough = o.radius - slack / 8;
    Point3 near = c + (o.radius + o.allowance - cutter.radius()) * n;
    if (free.nearest(x, o.radius + 2 * aside, enough, near) <= enough) return false;
    if (const double away = distance(near, x); away > enough) near = x + (enough / away) * (near - x);
    Point3 none;
    const bool may_be = roughly_free.nearest(x, o.radius + 2 * aside, o.radius + aside, none) <= o.radius + aside;
    return !may_be || !is_reached(*larger, surface, x, near, enough);
  };
  const auto columns = SurfaceGrid::Index(grid.columns());
  return kernel::parallel_blocks(context, grid.size(), 4096, [&](std::size_t first, std::size_t last) {
    for (std::size_t v = first; v < last; ++v) {
      const auto place = SurfaceGrid::Index(v);
      if (!grid.touches(place)) continue;
      const Point3 c = grid.centre(place), n = grid.normal(place);
      rest[v] = is_rest(c, n);
      // In a valley most is left between both sides.
      for (const SurfaceGrid::Index step : {SurfaceGrid::Index{1}, columns - 1, columns, columns + 1}) {
        const SurfaceGrid::Index other = place + step;
        if (rest[v] || other >= grid.size() || !grid.touches(other)) continue;
        const Point3 m = grid.normal(other), sum = n + m;
        if (dot(n, m) > least_turn || dot(grid.centre(other) - c, m - n) > 0 || length(sum) < 0.1) continue;
        rest[v] = is_rest(c, (1 / length(sum)) * sum);
      }
    }
  });
}

}  // namespace krepl::mill
