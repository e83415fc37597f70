#include "mill/boundary.hpp"

#include <algorithm>
#include <cmath>

#include "mill/plan.hpp"

namespace krepl::mill {
namespace {

/// Calls visit(t) where sides of a ring cross a line; a corner on it counts with one of its sides or with both.
template <class Visit>
void for_each_crossing(const std::vector<Point>& ring, const Line& line, const Visit& visit) {
  const Point d = line.direction;
  const auto along = [&](Point p) { return (p.x - line.origin.x) * d.x + (p.y - line.origin.y) * d.y; };
  const auto aside = [&](Point p) { return (p.y - line.origin.y) * d.x - (p.x - line.origin.x) * d.y; };
  Point p = ring.back();
  double v = aside(p);
  for (const Point q : ring) {
    const double w = aside(q);
    if ((v >= 0) != (w >= 0)) {
      const double a = along(p), b = along(q), s = v / (v - w);
      visit(a + s * (b - a));
    }
    p = q, v = w;
  }
}

}  // namespace

bool is_inside(const std::vector<Point>& ring, Point p) {
  bool inside = false;
  for_each_crossing(ring, {p, {1, 0}}, [&](double t) {
    if (t > 0) inside = !inside;
  });
  return inside;
}

Status check_boundary(const MillBoundary& boundary) {
  for (const auto& polygon : boundary.polygons)
    for (const auto& ring : polygon) {
      if (ring.size() < 3) return usage("a ring of the boundary has less than three points", "give polygons");
      for (const Point p : ring)
        if (!std::isfinite(p.x) || !std::isfinite(p.y)) return usage("a coordinate of the boundary is not finite", "");
    }
  return std::monostate{};
}

Boundary::Boundary(const MillBoundary& boundary, Point3 origin) : polygons_(boundary.polygons) {
  for (auto& polygon : polygons_)
    for (auto& ring : polygon)
      for (Point& p : ring) {
        p = {p.x - origin.x, p.y - origin.y};
        extent_ = std::max({extent_, std::abs(p.x), std::abs(p.y)});
      }
}

std::vector<Interval> Boundary::inside(const Line& line, double from, double to) const {
  std::vector<Interval> all;
  std::vector<double> crossings;
  for (const auto& polygon : polygons_) {
    crossings.clear();
    for (const auto& ring : polygon) for_each_crossing(ring, line, [&](double t) { crossings.push_back(t); });
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) {
      const double low = std::max(from, crossings[k]), high = std::min(to, crossings[k + 1]);
      if (low < high) all.push_back({low, high});
    }
  }
  std::sort(all.begin(), all.end(), [](Interval a, Interval b) { return a.low < b.low; });
  std::vector<Interval> joined;
  for (const Interval& i : all) {
    if (!joined.empty() && i.low <= joined.back().high)
      joined.back().high = std::max(joined.back().high, i.high);
    else
      joined.push_back(i);
  }
  return joined;
}

bool Boundary::contains(Point from, Point to) const {
  if (is_everywhere()) return true;
  const double dx = to.x - from.x, dy = to.y - from.y, length = std::hypot(dx, dy);
  const double rounding = 0x1p-40 * (extent_ + std::abs(from.x) + std::abs(from.y) + length);
  if (length <= rounding) return true;
  double reached = 0;
  for (const Interval& i : inside({from, {dx / length, dy / length}}, 0, length))
    if (i.low <= reached + rounding) reached = i.high;
  return reached >= length - rounding;
}

std::vector<std::vector<Point>> Boundary::inside(const std::vector<Point>& polyline) const {
  if (is_everywhere()) return {polyline};
  std::vector<std::vector<Point>> pieces;
  bool is_open = false;
  for (std::size_t k = 0; k + 1 < polyline.size(); ++k) {
    const Point p = polyline[k], q = polyline[k + 1];
    const double length = std::hypot(q.x - p.x, q.y - p.y);
    if (length == 0) continue;
    const Line line{p, {(q.x - p.x) / length, (q.y - p.y) / length}};
    bool reaches_end = false;
    for (const Interval& i : inside(line, 0, length)) {
      if (!(is_open && i.low == 0)) pieces.push_back({i.low == 0 ? p : line.at(i.low)});
      reaches_end = i.high == length;
      pieces.back().push_back(reaches_end ? q : line.at(i.high));
    }
    is_open = reaches_end;
  }
  // Of a closed line the first piece goes on where the last one ends.
  if (pieces.size() > 1 && is_open && polyline.front() == polyline.back() &&
      pieces.front().front() == polyline.front()) {
    pieces.back().insert(pieces.back().end(), pieces.front().begin() + 1, pieces.front().end());
    pieces.front() = std::move(pieces.back());
    pieces.pop_back();
  }
  return pieces;
}

}  // namespace krepl::mill
