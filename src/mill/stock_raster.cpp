#include "mill/stock_raster.hpp"

#include <algorithm>
#include <cmath>

namespace krepl::mill {
namespace {

constexpr double nothing = -1e300;

}  // namespace

StockRaster::StockRaster(const PlaneRaster& raster, Point low, Point high, double top, const Cutter& cutter)
    : raster_(raster), top_(raster.size(), nothing) {
  for (std::size_t v = 0; v < top_.size(); ++v) {
    const Point p = raster.place(v);
    if (p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y) top_[v] = top;
  }
  const auto list = [&](double more, std::vector<Offset>& offsets) {
    const auto reach = std::int64_t(std::ceil((cutter.radius() + more) / raster.step));
    for (std::int64_t y = -reach; y <= reach; ++y)
      for (std::int64_t x = -reach; x <= reach; ++x) {
        const double away = std::max(0.0, raster.step * std::hypot(double(x), double(y)) - more);
        if (away <= cutter.radius()) offsets.push_back({x, y, cutter.height(away)});
      }
  };
  list(0, tool_), list(2 * raster.step, wider_);
}

template <class Visit>
void StockRaster::visit(Point p, const std::vector<Offset>& offsets, const Visit& visit) const {
  const auto c = std::int64_t(std::llround((p.x - raster_.first.x) / raster_.step)),
             r = std::int64_t(std::llround((p.y - raster_.first.y) / raster_.step));
  for (const Offset& o : offsets) {
    const std::int64_t x = c + o.x, y = r + o.y;
    if (x < 0 || y < 0 || x >= std::int64_t(raster_.columns) || y >= std::int64_t(raster_.rows)) continue;
    if (!visit(std::size_t(y) * raster_.columns + std::size_t(x), o.height)) return;
  }
}

void StockRaster::cut(Point p, double tip) {
  visit(p, tool_, [&](std::size_t v, double height) {
    top_[v] = std::min(top_[v], tip + height);
    return true;
  });
}

void StockRaster::cut(Point from, double from_tip, Point to, double to_tip) {
  const double count = std::max(1.0, std::ceil(std::hypot(to.x - from.x, to.y - from.y) / raster_.step));
  for (double n = 0; n <= count; ++n) {
    const double t = n / count;
    cut({from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)}, from_tip + t * (to_tip - from_tip));
  }
}

bool StockRaster::is_cut(Point p, double tip, double least) const {
  bool found = false;
  visit(p, tool_, [&](std::size_t v, double height) { return !(found = top_[v] > tip + height + least); });
  return found;
}

double StockRaster::clear_height(Point p) const {
  double tip = nothing;
  visit(p, wider_, [&](std::size_t v, double height) {
    tip = std::max(tip, top_[v] - height);
    return true;
  });
  return tip;
}

}  // namespace krepl::mill
