#include "arcs/curve_locator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/odd_ones.hpp"
#include "model/arc_circle.hpp"
#include "zone/ray_crossing.hpp"

namespace krepl::arcs {

CurveLocator::CurveLocator(const CurveNetwork& network) : sides_(sides_of(network)), tree_(boxes_of(sides_)) {}

std::vector<CurveLocator::Side> CurveLocator::sides_of(const CurveNetwork& network) {
  std::vector<Side> sides;
  const Network& straight = network.straight();
  for (std::uint32_t part = 0; part < straight.part_count(); ++part) {
    if (!straight.part_is_ring(part)) continue;
    const auto chain = straight.part(part);
    const auto middles = network.part_middles(part);
    const std::int64_t feature = straight.part_feature(part);
    const auto at = [&](std::size_t i) { return straight.vertices()[chain[i % chain.size()]]; };
    auto middle = middles.begin();
    for (std::size_t i = 0; i < chain.size(); ++i) {
      if (middle == middles.end() || *middle != i + 1) {
        if (!(at(i) == at(i + 1))) sides.push_back({at(i), at(i + 1), feature, false, false, false, {}});
        continue;
      }
      const Point p = at(i), m = at(i + 1), q = at(i + 2);
      const auto circle = model::arc_circle<kernel::quad>(p, m, q);
      Side side{p, q, feature, true, circle.left, false, {double(circle.to_center_x), double(circle.to_center_y)}};
      side.arc = std::isfinite(side.to_centre.x) && std::isfinite(side.to_centre.y);
      // The angle at the middle is less than 90 degrees over more than half a turn.
      side.wide = (m.x - p.x) * (q.x - m.x) + (m.y - p.y) * (q.y - m.y) < 0;
      sides.push_back(side);
      ++middle, ++i;
    }
  }
  return sides;
}

std::vector<kernel::Box> CurveLocator::boxes_of(const std::vector<Side>& sides) {
  std::vector<kernel::Box> boxes((sides.size() + chunk - 1) / chunk);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Side& s = sides[i];
    kernel::Box& box = boxes[i / chunk];
    box.add(s.p), box.add(s.q);
    if (!s.arc) continue;
    const Point w = s.to_centre;
    const double r = std::hypot(w.x, w.y), half = std::hypot(s.q.x - s.p.x, s.q.y - s.p.y) / 2;
    const double reach = s.wide ? 2 * r : half * half / r;  // from either end; an arc's height is less
    for (const Point e : {s.p, s.q}) {
      box.add(Point{e.x - reach, e.y - reach});
      box.add(Point{e.x + reach, e.y + reach});
    }
  }
  return boxes;
}

bool CurveLocator::is_crossed(const Side& s, Point from) {
  if (!s.arc) return zone::ray_crosses_segment(s.p, s.q, from);
  const Point v{from.x - s.p.x, from.y - s.p.y}, w = s.to_centre;
  const bool in_circle = v.x * (v.x - 2 * w.x) + v.y * (v.y - 2 * w.y) < 0;
  return zone::ray_crosses_arc(s.p, s.q, s.left, in_circle, from);
}

bool CurveLocator::is_inside(Point p) const {
  std::vector<std::int64_t> features;
  const auto far = [] { return -std::numeric_limits<double>::infinity(); };
  tree_.visit_left_of(p, far, [&](std::size_t box) {
    for (std::size_t i = box * chunk; i < std::min(sides_.size(), (box + 1) * chunk); ++i)
      if (is_crossed(sides_[i], p)) features.push_back(sides_[i].feature);
  });
  kernel::keep_odd_ones(features);
  return !features.empty();
}

}  // namespace krepl::arcs
